#pragma once
#include "engine/core/text.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/fault.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/value_text.hpp"

#include <algorithm>
#include <functional>
#include <variant>

namespace tumble {

/// Where a validator puts what it finds: a full path and a message.
using FaultSink = std::function<void(std::string path, std::string message)>;

/// Visitor that checks the ranges of a description and calls each struct's own check().
class ObjectValidator {
 public:
  ObjectValidator(const FaultSink& sink, std::string path) : sink_(sink), path_(std::move(path)) {}

  template <class T>
  void field(const T& value, const Parameter& p) {
    check_value(value, p, at(p.name));
  }
  template <class T>
  void object(const T& value, const Parameter& p) {
    visit(value, at(p.name));
  }
  template <class T>
  void object(const std::optional<T>& value, const Parameter& p) {
    if (value) visit(*value, at(p.name));
  }
  template <class T>
  void list(const std::vector<T>& values, const Parameter& p) {
    for (size_t i = 0; i < values.size(); ++i) visit(values[i], element(at(p.name), i));
  }
  template <class T>
  void map(const NamedList<T>& values, const Parameter& p) {
    for (const auto& item : values.items) visit(item.value, at(p.name) + "." + item.name);
  }
  template <class... Ts>
  void one_of(const std::variant<Ts...>& value, const Parameter&) {
    std::visit([this](const auto& alternative) { this->part(alternative); }, value);
  }
  template <class T>
  void part(const T& value) {
    T::parameters(*this, value);
    own_check(value);
  }

  template <class T>
  void visit(const T& value, std::string path) {
    ObjectValidator inner(sink_, std::move(path));
    inner.part(value);
  }

 private:
  std::string at(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }
  static std::string element(const std::string& path, size_t i) {
    return path + "[" + std::to_string(i) + "]";
  }
  void check_number(double value, const Parameter& p, const std::string& path) {
    if (std::string fault = range_fault(value, p); !fault.empty()) sink_(path, std::move(fault));
  }

  void check_value(double value, const Parameter& p, const std::string& path) {
    check_number(value, p, path);
  }
  void check_value(const Varying& value, const Parameter& p, const std::string& path) {
    check_number(value.value, p, path);
    if (!value.course) return;
    for (size_t i = 0; i < value.course->points().size(); ++i)
      check_number(value.course->points()[i].second, p, element(path, i) + "[1]");
  }
  void check_value(int value, const Parameter& p, const std::string& path) {
    check_number(value, p, path);
  }
  void check_value(const Vec3& value, const Parameter& p, const std::string& path) {
    for (int i = 0; i < 3; ++i) check_number(value[i], p, element(path, size_t(i)));
  }
  void check_value(const std::array<int, 3>& value, const Parameter& p, const std::string& path) {
    for (size_t i = 0; i < 3; ++i) check_number(value[i], p, element(path, i));
  }
  void check_value(const Quat& value, const Parameter& p, const std::string& path) {
    check_value(Vec3(value.vec()), p, path);
    check_number(value.w(), p, path);
  }
  void check_value(const Colour& value, const Parameter&, const std::string& path) {
    const Parameter unit{.name = "", .min = 0, .max = 1};
    const double parts[3] = {value.r, value.g, value.b};
    for (size_t i = 0; i < 3; ++i) check_number(parts[i], unit, element(path, i));
  }
  void check_value(const TickRate& value, const Parameter& p, const std::string& path) {
    check_number(value.den == 0 ? 0 : double(value.num) / double(value.den), p, path);
  }
  template <class T>
  void check_value(const std::optional<T>& value, const Parameter& p, const std::string& path) {
    if (value) check_value(*value, p, path);
  }
  template <class T>
  void check_value(const std::vector<T>& values, const Parameter& p, const std::string& path) {
    for (size_t i = 0; i < values.size(); ++i) check_value(values[i], p, element(path, i));
  }
  void check_value(const std::string& value, const Parameter& p, const std::string& path) {
    const std::vector<std::string> known = known_names(p.name);
    if (!known.empty() && std::find(known.begin(), known.end(), value) == known.end())
      sink_(path, unknown_name(p.name, value, known));
  }
  void check_value(uint64_t, const Parameter&, const std::string&) {}
  void check_value(bool, const Parameter&, const std::string&) {}
  template <class E>
  requires std::is_enum_v<E>
  void check_value(E, const Parameter&, const std::string&) {}

  template <class T>
  void own_check(const T& value) {
    if constexpr (requires(Complaints & c) { T::check(value, c); }) {
      struct Adapter final : Complaints {
        const ObjectValidator& owner;
        explicit Adapter(const ObjectValidator& o) : owner(o) {}
        void add(std::string_view member, std::string message) override {
          owner.sink_(member.empty() ? owner.path_ : owner.at(member), std::move(message));
        }
      } adapter(*this);
      T::check(value, adapter);
    }
  }

  const FaultSink& sink_;
  std::string path_;
};

}  // namespace tumble
