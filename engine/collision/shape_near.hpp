#pragma once
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

namespace tumble {

/// closest_point() with open meshes seen from either side: their distance is never negative, and
/// the normal points towards x.
inline std::optional<ClosestPoint> near_shape(const Shape& shape, const Pose& pose, const Vec3& x,
                                              double max_distance) {
  auto near = closest_point(shape, pose, x, max_distance);
  if (!near || near->distance >= 0 || shape.type() != ShapeType::triangle_mesh ||
      shape.polyhedral()->surface().closed)
    return near;
  near->distance = -near->distance;
  near->normal = -near->normal;
  if (near->distance > max_distance) return std::nullopt;
  return near;
}

}  // namespace tumble
