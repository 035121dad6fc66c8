#include "engine/scene/description/shape.hpp"

namespace tumble {
namespace {

bool in_range(double value, const Parameter& p) {
  return value <= p.max && (p.exclusive_min ? value > p.min : value >= p.min);
}

bool all_in_range(const ShapeDef& def) {
  for (const ShapeParameter& p : shape_entry(def.type).parameters) {
    if (p.number && !in_range(def.*p.number / p.factor, p.parameter)) return false;
    if (!p.vector) continue;
    for (int k = 0; k < 3; ++k)
      if (!in_range((def.*p.vector)[k] / p.factor, p.parameter)) return false;
  }
  return true;
}

template <size_t place = 0>
ShapeKind kind_at(const ShapeDef& def) {
  if constexpr (place < shape_type_count - mesh_shape_count) {
    if (all_shapes()[place].type != def.type) return kind_at<place + 1>(def);
    ListedShapeDescription<place> out;
    out.def = def;
    return out;
  } else {
    return ShapeKind();
  }
}

}  // namespace

std::string shape_fault(const ShapeDef& def) {
  if (!all_in_range(def)) return "";  // the range of the number itself is reported elsewhere
  const auto made = make_shape(def);
  return made ? "" : made.error().message;
}

ShapeKind shape_kind(const ShapeDef& def) {
  return kind_at(def);
}

}  // namespace tumble
