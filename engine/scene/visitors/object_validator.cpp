#include "engine/scene/visitors/object_validator.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/value_text.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Passes on the faults that a struct's own check finds.
class OwnFaults final : public Complaints {
 public:
  OwnFaults(const FaultSink& sink, const std::string& path) : sink_(sink), path_(path) {}

  void add(std::string_view member, std::string message) override {
    const bool whole = member.empty() || path_.empty();
    sink_(whole ? path_ + std::string(member) : path_ + "." + std::string(member),
          std::move(message));
  }

 private:
  const FaultSink& sink_;
  const std::string& path_;
};

std::string element(const std::string& path, size_t i) {
  return path + "[" + std::to_string(i) + "]";
}

class ObjectValidator final : public StructVisitor {
 public:
  ObjectValidator(const FaultSink& sink, const std::string& path) : sink_(sink), path_(path) {}

  void field(const Leaf& value, const Parameter& p) override { check_leaf(value, p, at(p.name)); }
  void object(const StructRef& value, const Parameter& p) override {
    validate_object(value, at(p.name), sink_);
  }
  void object(const OptionalRef& value, const Parameter& p) override {
    if (value.has()) validate_object(value.get(), at(p.name), sink_);
  }
  void list(const ListRef& values, const Parameter& p) override {
    for (size_t i = 0; i < values.size(); ++i)
      validate_object(values.at(i), element(at(p.name), i), sink_);
  }
  void map(const MapRef& values, const Parameter& p) override {
    for (size_t i = 0; i < values.size(); ++i)
      validate_object(values.at(i), at(p.name) + "." + values.name(i), sink_);
  }
  void one_of(const VariantRef& value, const Parameter&) override { part(value.get()); }
  void part(const StructRef& value) override {
    value.type->parameters(value.object, *this);
    if (!value.type->check) return;
    OwnFaults faults(sink_, path_);
    value.type->check(value.object, faults);
  }

 private:
  std::string at(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }

  void check_leaf(const Leaf& leaf, const Parameter& p, const std::string& path) {
    std::visit(
        [&](const auto& value) {
          if constexpr (std::is_pointer_v<std::decay_t<decltype(value)>>)
            check(*value, p, path);
          else
            check(value, p, path);
        },
        static_cast<const Leaf::variant&>(leaf));
  }
  void check(double value, const Parameter& p, const std::string& path) {
    if (std::string fault = range_fault(value, p); !fault.empty()) sink_(path, std::move(fault));
  }
  void check(const Varying& value, const Parameter& p, const std::string& path) {
    check(value.value, p, path);
    if (!value.course) return;
    for (size_t i = 0; i < value.course->points().size(); ++i)
      check(value.course->points()[i].second, p, element(path, i) + "[1]");
  }
  void check(const VaryingVec3& value, const Parameter& p, const std::string& path) {
    for (size_t i = 0; i < 3; ++i) check(value.of[i], p, element(path, i));
  }
  void check(int value, const Parameter& p, const std::string& path) {
    check(double(value), p, path);
  }
  void check(const Vec3& value, const Parameter& p, const std::string& path) {
    for (int i = 0; i < 3; ++i) check(value[i], p, element(path, size_t(i)));
  }
  void check(const std::array<int, 3>& value, const Parameter& p, const std::string& path) {
    for (size_t i = 0; i < 3; ++i) check(value[i], p, element(path, i));
  }
  void check(const Quat& value, const Parameter& p, const std::string& path) {
    check(Vec3(value.vec()), p, path);
    check(value.w(), p, path);
  }
  void check(const Colour& value, const Parameter&, const std::string& path) {
    const Parameter unit{.name = "", .min = 0, .max = 1};
    const double parts[3] = {value.r, value.g, value.b};
    for (size_t i = 0; i < 3; ++i) check(parts[i], unit, element(path, i));
  }
  void check(const TickRate& value, const Parameter& p, const std::string& path) {
    check(value.den == 0 ? 0 : double(value.num) / double(value.den), p, path);
  }
  void check(const std::string& value, const Parameter& p, const std::string& path) {
    const std::vector<std::string> known = known_names(p.name);
    if (!known.empty() && std::find(known.begin(), known.end(), value) == known.end())
      sink_(path, unknown_name(p.name, value, known));
  }
  void check(uint64_t, const Parameter&, const std::string&) {}
  void check(bool, const Parameter&, const std::string&) {}
  void check(const EnumRef&, const Parameter&, const std::string&) {}
  void check(const OptionalLeafRef& value, const Parameter& p, const std::string& path) {
    if (value.type->has(value.option)) check_leaf(value.type->get(value.option), p, path);
  }
  void check(const LeafListRef& values, const Parameter& p, const std::string& path) {
    for (size_t i = 0; i < values.type->size(values.list); ++i)
      check_leaf(values.type->at(values.list, i), p, element(path, i));
  }

  const FaultSink& sink_;
  const std::string& path_;
};

}  // namespace

void validate_object(const StructRef& value, const std::string& path, const FaultSink& sink) {
  ObjectValidator(sink, path).part(value);
}

}  // namespace tumble
