#include "engine/collision/shape.hpp"

#include "engine/collision/shapes/box.hpp"
#include "engine/collision/shapes/capsule.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/shapes/cylinder.hpp"
#include "engine/collision/shapes/ellipsoid.hpp"
#include "engine/collision/shapes/half_space.hpp"
#include "engine/collision/shapes/sphere.hpp"
#include "engine/collision/shapes/triangle_mesh.hpp"

namespace tumble {

const std::vector<ShapeEntry>& all_shapes() {
  static const std::vector<ShapeEntry> list{
      {"sphere", ShapeType::sphere, SphereShape::make},
      {"capsule", ShapeType::capsule, CapsuleShape::make},
      {"box", ShapeType::box, BoxShape::make},
      {"cylinder", ShapeType::cylinder, CylinderShape::make},
      {"ellipsoid", ShapeType::ellipsoid, EllipsoidShape::make},
      {"half_space", ShapeType::half_space, HalfSpaceShape::make},
      {"convex_hull", ShapeType::convex_hull, ConvexHullShape::make},
      {"triangle_mesh", ShapeType::triangle_mesh, TriangleMeshShape::make},
  };
  return list;
}

Result<std::shared_ptr<const Shape>> make_shape(const ShapeDef& def) {
  for (const ShapeEntry& entry : all_shapes())
    if (entry.type == def.type) return entry.make(def);
  return Error{ErrorCode::invalid_argument, "unknown shape type", {}, {}};
}

}  // namespace tumble
