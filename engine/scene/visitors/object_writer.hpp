#pragma once
#include "engine/scene/description.hpp"

#include <variant>

#include <nlohmann/json.hpp>

namespace tumble {

using Json = nlohmann::ordered_json;

// Leaves of a scene file.
inline Json to_json(double v) {
  return v;
}
inline Json to_json(int v) {
  return v;
}
inline Json to_json(uint64_t v) {
  return v;
}
inline Json to_json(bool v) {
  return v;
}
inline Json to_json(const std::string& v) {
  return v;
}
inline Json to_json(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}
inline Json to_json(const Quat& q) {
  return Json::array({q.w(), q.x(), q.y(), q.z()});
}
inline Json to_json(const std::array<int, 3>& v) {
  return Json::array({v[0], v[1], v[2]});
}
Json to_json(const Colour& colour);
Json to_json(const Varying& number);
Json to_json(const TickRate& rate);
template <class E>
requires std::is_enum_v<E> Json to_json(E value) {
  return std::string(enum_name(value));
}
template <class T>
Json to_json(const std::vector<T>& values) {
  Json out = Json::array();
  for (const T& v : values) out.push_back(to_json(v));
  return out;
}

/// Visitor that writes a description struct as a JSON object, without what is as in `defaults`
/// (when there are any).
class ObjectWriter {
 public:
  explicit ObjectWriter(const Json* defaults) : defaults_(defaults) {}

  template <class T>
  void field(const T& value, const Parameter& p) {
    put(p, to_json(value));
  }
  template <class T>
  void field(const std::optional<T>& value, const Parameter& p) {
    if (value) put(p, to_json(*value));
  }
  template <class T>
  void object(const T& value, const Parameter& p) {
    Json made = write_object(value);
    if (!made.empty() || p.required) out_[std::string(p.name)] = std::move(made);
  }
  template <class T>
  void object(const std::optional<T>& value, const Parameter& p) {
    if (value) out_[std::string(p.name)] = write_object(*value);
  }
  template <class T>
  void list(const std::vector<T>& values, const Parameter& p) {
    if (values.empty()) return;
    Json array = Json::array();
    for (const T& v : values) array.push_back(write_object(v));
    out_[std::string(p.name)] = std::move(array);
  }
  template <class T>
  void map(const NamedList<T>& values, const Parameter& p) {
    if (values.empty()) return;
    Json object = Json::object();
    for (const auto& item : values.items) object[item.name] = write_object(item.value);
    out_[std::string(p.name)] = std::move(object);
  }
  template <class... Ts>
  void one_of(const std::variant<Ts...>& value, const Parameter& p) {
    if (!defaults_) return;  // the defaults of an alternative are its own
    std::visit(
        [&]<class T>(const T& alternative) {
          out_[std::string(p.name)] = std::string(type_name_of<T>());
          const Json made = write_object(alternative);
          for (const auto& item : made.items()) out_[item.key()] = item.value();
        },
        value);
  }
  template <class T>
  void part(const T& value) {
    T::parameters(*this, value);
  }

  Json take() { return std::move(out_); }

  /// Every value, also those that are defaults.
  template <class T>
  static Json write_all(const T& value) {
    ObjectWriter writer(nullptr);
    T::parameters(writer, value);
    return writer.take();
  }
  template <class T>
  static Json write_object(const T& value) {
    static const Json defaults = write_all(T());
    ObjectWriter writer(&defaults);
    T::parameters(writer, value);
    Json out = writer.take();
    if constexpr (requires { T::shorthand_key; }) {
      const std::string key(T::shorthand_key);
      if (out.size() == 1 && out.contains(key)) return Json(out[key]);
    }
    return out;
  }

 private:
  void put(const Parameter& p, Json value) {
    const std::string name(p.name);
    if (!p.required && defaults_) {
      const auto it = defaults_->find(name);
      if (it != defaults_->end() ? *it == value : value.is_array() && value.empty()) return;
    }
    out_[name] = std::move(value);
  }

  const Json* defaults_;
  Json out_ = Json::object();
};

}  // namespace tumble
