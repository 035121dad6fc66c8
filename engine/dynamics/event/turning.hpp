#pragma once
#include "engine/dynamics/event/reach.hpp"

namespace tumble {

/// Upper bound of |turn x r| over the points r of a body relative to its centre of mass; `turn` in
/// body axes, `half` as in BodyReach.
double greatest_turn(const RigidBody& body, const Vec3& half, const Vec3& turn);

/// Greatest speed of any point about the centre of mass [m/s].
inline double turning_speed(const RigidBody& b, const Vec3& half) {
  return greatest_turn(b, half, b.pose.inverse_direction(b.omega));
}

/// The same for velocity components along a unit normal (world axes), which spin about that normal
/// does not have.
double turning_speed_along(const RigidBody& body, const Vec3& half, const Vec3& normal);

}  // namespace tumble
