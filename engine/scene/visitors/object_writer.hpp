#pragma once
#include "engine/scene/visitors/structure.hpp"

#include <nlohmann/json.hpp>

namespace tumble {

using Json = nlohmann::ordered_json;

/// The JSON of a leaf; null if it is absent.
Json to_json(const Leaf& leaf);
inline Json to_json(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}
inline Json to_json(const Quat& q) {
  return Json::array({q.w(), q.x(), q.y(), q.z()});
}

/// A struct as a JSON object, or as its shorthand value, without members that have their default
/// values.
Json write_object(const StructRef& value);
/// The same with all members.
Json write_all(const StructRef& value);

template <class T>
Json write_object(const T& value) {
  return write_object(struct_ref(value));
}
template <class T>
Json write_all(const T& value) {
  return write_all(struct_ref(value));
}

}  // namespace tumble
