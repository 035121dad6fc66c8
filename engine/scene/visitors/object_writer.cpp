#include "engine/scene/visitors/object_writer.hpp"

#include <cmath>
#include <map>
#include <mutex>

#include <fmt/format.h>

namespace tumble {
namespace {

Json json_of(double v) {
  return v;
}
Json json_of(int v) {
  return v;
}
Json json_of(uint64_t v) {
  return v;
}
Json json_of(bool v) {
  return v;
}
Json json_of(const std::string& v) {
  return v;
}
Json json_of(const Vec3& v) {
  return to_json(v);
}
Json json_of(const Quat& q) {
  return to_json(q);
}
Json json_of(const std::array<int, 3>& v) {
  return Json::array({v[0], v[1], v[2]});
}

Json json_of(const Colour& colour) {
  const double parts[3] = {colour.r, colour.g, colour.b};
  int bytes[3];
  bool exact = true;
  for (size_t i = 0; i < 3; ++i) {
    const double scaled = std::floor(parts[i] * 255 + 0.5);
    exact &= scaled >= 0 && scaled <= 255 && scaled / 255 == parts[i];
    bytes[i] = exact ? int(scaled) : 0;
  }
  if (!exact) return Json::array({colour.r, colour.g, colour.b});
  return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

Json json_of(const Varying& number) {
  if (!number.course) return number.value;
  if (!number.course->text().empty()) return "=" + number.course->text();
  Json out = Json::array();
  for (const auto& [t, value] : number.course->points()) out.push_back(Json::array({t, value}));
  return out;
}

Json json_of(const VaryingVec3& v) {
  return Json::array({json_of(v.of[0]), json_of(v.of[1]), json_of(v.of[2])});
}

Json json_of(const TickRate& rate) {
  if (rate.den == 1) return rate.num;
  return fmt::format("{}/{}", rate.num, rate.den);
}

Json json_of(const EnumRef& value) {
  return value.type->names[value.type->get(value.value)];
}

Json json_of(const OptionalLeafRef& value) {
  return value.type->has(value.option) ? to_json(value.type->get(value.option)) : Json();
}

Json json_of(const LeafListRef& values) {
  Json out = Json::array();
  for (size_t i = 0; i < values.type->size(values.list); ++i)
    out.push_back(to_json(values.type->at(values.list, i)));
  return out;
}

class ObjectWriter final : public StructVisitor {
 public:
  /// Leaves out values that are equal to those in `defaults`; null: writes all.
  explicit ObjectWriter(const Json* defaults) : defaults_(defaults) {}

  void field(const Leaf& value, const Parameter& p) override {
    const auto* option = std::get_if<OptionalLeafRef>(&value);
    if (!option || option->type->has(option->option)) put(p, to_json(value));
  }
  void object(const StructRef& value, const Parameter& p) override {
    Json made = write_object(value);
    if (!made.empty() || p.required) out_[std::string(p.name)] = std::move(made);
  }
  void object(const OptionalRef& value, const Parameter& p) override {
    if (value.has()) out_[std::string(p.name)] = write_object(value.get());
  }
  void list(const ListRef& values, const Parameter& p) override {
    if (values.size() == 0) return;
    Json array = Json::array();
    for (size_t i = 0; i < values.size(); ++i) array.push_back(write_object(values.at(i)));
    out_[std::string(p.name)] = std::move(array);
  }
  void map(const MapRef& values, const Parameter& p) override {
    if (values.size() == 0) return;
    Json object = Json::object();
    for (size_t i = 0; i < values.size(); ++i) object[values.name(i)] = write_object(values.at(i));
    out_[std::string(p.name)] = std::move(object);
  }
  void one_of(const VariantRef& value, const Parameter& p) override {
    if (!defaults_) return;  // an alternative has its own defaults
    const StructRef alternative = value.get();
    out_[std::string(p.name)] = std::string(alternative.type->type_name);
    const Json made = write_object(alternative);
    for (const auto& item : made.items()) out_[item.key()] = item.value();
  }
  void part(const StructRef& value) override { value.type->parameters(value.object, *this); }

  Json take() { return std::move(out_); }

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

/// The JSON of a default-constructed struct, with all values.
const Json& defaults_of(const StructType& type) {
  static std::mutex mutex;
  static std::map<const StructType*, Json> known;
  {
    const std::lock_guard lock(mutex);
    if (const auto it = known.find(&type); it != known.end()) return it->second;
  }
  Json made = write_all(StructRef{const_cast<void*>(type.defaults), &type});
  const std::lock_guard lock(mutex);
  return known.emplace(&type, std::move(made)).first->second;
}

}  // namespace

Json to_json(const Leaf& leaf) {
  return std::visit(
      [](const auto& value) {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(value)>>)
          return json_of(*value);
        else
          return json_of(value);
      },
      static_cast<const Leaf::variant&>(leaf));
}

Json write_all(const StructRef& value) {
  ObjectWriter writer(nullptr);
  writer.part(value);
  return writer.take();
}

Json write_object(const StructRef& value) {
  ObjectWriter writer(&defaults_of(*value.type));
  writer.part(value);
  Json out = writer.take();
  const std::string key(value.type->shorthand_key);
  if (!key.empty() && out.size() == 1 && out.contains(key)) return Json(out[key]);
  return out;
}

}  // namespace tumble
