#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <algorithm>

namespace tumble {

/// Bounds of a body of several shapes at `pose`, from the box of its tree.
inline Aabb whole_bounds(const BoundsTree& tree, const Pose& pose) {
  const Aabb box = tree.bounds();
  const Vec3 half = 0.5 * box.extent();
  if (!half.allFinite()) return box;
  const Vec3 out = pose.q.toRotationMatrix().cwiseAbs() * half, x = pose.point(box.centre());
  return {x - out, x + out};
}

/// How far any point of a body may leave the motion of its centre by rotation in a tick of h
/// seconds [m].
inline double whole_turning(const RigidBody& body, double h) {
  const double angle = body.omega.norm() * h;
  return angle > 0 ? std::min(angle, 2.0) * body.bounding_radius : 0;
}

}  // namespace tumble
