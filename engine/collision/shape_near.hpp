#pragma once
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"

#include <cmath>

namespace tumble {

/// closest_point(), but for open meshes with two sides: their distance is never negative, and the
/// normal points towards x, or for a point on the surface to its front.
inline std::optional<ClosestPoint> near_shape(const Shape& shape, const Pose& pose, const Vec3& x,
                                              double max_distance) {
  if (!shape.is_mesh() || shape.polyhedral()->surface().closed)
    return closest_point(shape, pose, x, max_distance);
  const MeshSurface& s = shape.polyhedral()->surface();
  const Vec3 p = pose.inverse_point(x);
  if (!p.allFinite()) return std::nullopt;
  const auto near = s.tree->closest(p, max_distance);
  if (!near) return std::nullopt;
  ClosestPoint c;
  c.triangle = near->triangle;
  c.distance = std::sqrt(near->squared_distance);
  if (c.distance > max_distance) return std::nullopt;
  if (c.distance > 0) {
    c.normal = (p - near->point) / c.distance;
  } else {
    const Vec3 n = face_normal(*s.mesh, c.triangle);
    if (!n.isZero(0)) c.normal = n;
  }
  c.x_world = pose.point(near->point);
  c.normal = pose.direction(c.normal);
  return c;
}

/// near_shape() for contacts: a shape with a field (Shape::field) uses it, with its error, and
/// gives no triangle. Outside the field's narrow band, and where its gradient has no direction, the
/// exact distance of the mesh is used.
inline std::optional<ClosestPoint> near_to_touch(const Shape& shape, const Pose& pose,
                                                 const Vec3& x, double max_distance) {
  const DistanceField* field = shape.field();
  if (!field) return near_shape(shape, pose, x, max_distance);
  const DistanceSample at = field->sample(pose.inverse_point(x));
  if (at.distance - at.error > max_distance) return std::nullopt;
  const double length = at.gradient.norm();
  constexpr double no_direction = 0.5;  // equally far from two sides
  if (at.level != FieldLevel::band || length < no_direction)
    return near_shape(shape, pose, x, max_distance);
  if (at.distance > max_distance) return std::nullopt;
  ClosestPoint c;
  c.distance = at.distance;
  c.normal = pose.direction(at.gradient / length);
  c.x_world = x - c.distance * c.normal;
  return c;
}

}  // namespace tumble
