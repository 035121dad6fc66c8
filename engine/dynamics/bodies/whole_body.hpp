#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <algorithm>

namespace tumble {

/// Bounds of all shapes of a body, which has some, where it is at `pose`: for several, those of the
/// box about them.
inline Aabb whole_bounds(const RigidBody& body, const Pose& pose) {
  if (!body.tree) return body.shapes[0].shape->bounds(pose * body.shapes[0].pose);
  const Aabb box = body.tree->bounds();
  const Vec3 half = 0.5 * box.extent();
  if (!half.allFinite()) return box;
  const Vec3 out = pose.q.toRotationMatrix().cwiseAbs() * half, x = pose.point(box.centre());
  return {x - out, x + out};
}

/// How far any point of a body leaves the motion of its centre in a tick [m].
inline double whole_turning(const RigidBody& body, double h) {
  const double angle = body.omega.norm() * h;
  return angle > 0 ? std::min(angle, 2.0) * body.bounding_radius : 0;
}

}  // namespace tumble
