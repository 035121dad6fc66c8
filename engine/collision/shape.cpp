#include "engine/collision/shape.hpp"

namespace tumble {

// Each is defined in its file of shapes/.
extern const ShapeEntry sphere_entry, capsule_entry, box_entry, cylinder_entry, ellipsoid_entry,
    half_space_entry, cone_entry, tapered_capsule_entry, convex_hull_entry, triangle_mesh_entry,
    distance_field_entry;

const std::vector<ShapeEntry>& all_shapes() {
  static const std::vector<ShapeEntry> list{
      sphere_entry,        capsule_entry,         box_entry,
      cylinder_entry,      ellipsoid_entry,       half_space_entry,
      cone_entry,          tapered_capsule_entry, convex_hull_entry,
      triangle_mesh_entry, distance_field_entry,
  };
  return list;
}

const ShapeEntry& shape_entry(ShapeType type) {
  for (const ShapeEntry& entry : all_shapes())
    if (entry.type == type) return entry;
  return all_shapes().front();
}

Result<std::shared_ptr<const Shape>> make_shape(const ShapeDef& def) {
  for (const ShapeEntry& entry : all_shapes())
    if (entry.type == def.type) return entry.make(def);
  return Error{ErrorCode::invalid_argument, "unknown shape type", {}, {}};
}

bool made_of_mesh(ShapeType type) {
  const auto& all = all_shapes();
  const size_t place = size_t(&shape_entry(type) - all.data());
  return place + mesh_shape_count >= all.size();
}

ShapeDef ball_def(double radius) {
  ShapeDef def;
  def.type = ShapeType::sphere;
  def.radius = radius;
  return def;
}

}  // namespace tumble
