#pragma once
// Joints between bodies that a test holds in a list of its own.
#include "engine/dynamics/joints/joint.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tumble::test {

/// A joint at a frame in the world (z: main axis) between slots; no_body for the world.
inline Joint joint_at(JointKind kind, std::span<const RigidBody> bodies, uint32_t a, uint32_t b,
                      const Pose& at, bool collide = false) {
  Joint j;
  j.kind = kind;
  j.a = a;
  j.b = b;
  j.frame_a = a == no_body ? at : bodies[a].pose.inverse() * at;
  j.frame_b = bodies[b].pose.inverse() * at;
  j.collide = collide;
  return j;
}

/// Greatest error of the joints' rows now [m, rad].
inline double worst_error(std::span<const Joint> joints, std::span<const RigidBody> bodies) {
  double worst = 0;
  for (const Joint& j : joints) {
    JointRows rows;
    joint_rows(j.kind, joint_sides(j, bodies), rows);
    for (const JointRow& r : rows.all()) worst = std::max(worst, std::fabs(r.error));
  }
  return worst;
}

}  // namespace tumble::test
