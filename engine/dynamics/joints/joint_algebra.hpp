#pragma once
#include "engine/dynamics/joints/joint_part.hpp"

namespace tumble {

/// C = u.w for an axis u of A and an axis w of B, world axes: zero if they are perpendicular. dC/dt
/// = (w x u).(omega_b - omega_a).
inline void put_dot_row(const JointSides& s, const Vec3& u, const Vec3& w, JointRow& out) {
  const Vec3 turn = w.cross(u);
  const Vec3 turn_rate = s.b.omega.cross(w).cross(u) + w.cross(s.a.omega.cross(u));
  out.row.a = {s.a.block, Vec3::Zero(), -turn};
  out.row.b = {s.b.block, Vec3::Zero(), turn};
  out.error = u.dot(w);
  out.bias = turn_rate.dot(s.b.omega - s.a.omega);
}
inline JointRow dot_row(const JointSides& s, const Vec3& u, const Vec3& w) {
  JointRow out;
  put_dot_row(s, u, w, out);
  return out;
}

/// C = u.d for an axis u of A and d from A's anchor to B's, world axes. Its force on A acts at the
/// point of A that coincides with B's anchor: the lever arm on A is arm_a + d.
JointRow offset_row(const JointSides& sides, const Vec3& u);

/// C = the angle whose cosine and sine are proportional to the errors of two dot or offset rows,
/// -pi .. pi.
JointRow direction_row(const JointSides& sides, const JointRow& cosine, const JointRow& sine);

/// C = the distance of the anchors. If they coincide, its direction is the z axis of A's frame.
JointRow distance_row(const JointSides& sides);

}  // namespace tumble
