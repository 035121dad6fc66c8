#pragma once
#include "engine/dynamics/event/reach.hpp"

namespace tumble {

/// Greatest length of turn x r over the points r of a body, or what is more; `turn` in body axes,
/// `half` as in BodyReach.
double greatest_turn(const RigidBody& body, const Vec3& half, const Vec3& turn);

/// Greatest speed of any point about the centre of mass [m/s].
inline double turning_speed(const RigidBody& b, const Vec3& half) {
  return greatest_turn(b, half, b.pose.inverse_direction(b.omega));
}

/// Likewise along a unit normal, world axes, which the body may spin about.
double turning_speed_along(const RigidBody& body, const Vec3& half, const Vec3& normal);

}  // namespace tumble
