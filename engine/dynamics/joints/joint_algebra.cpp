#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow dot_row(const JointSides& s, const Vec3& u, const Vec3& w) {
  const Vec3 turn = w.cross(u);
  const Vec3 turn_rate = s.b.omega.cross(w).cross(u) + w.cross(s.a.omega.cross(u));
  JointRow out;
  out.row.a = {s.a.block, Vec3::Zero(), -turn};
  out.row.b = {s.b.block, Vec3::Zero(), turn};
  out.error = u.dot(w);
  out.bias = turn_rate.dot(s.b.omega - s.a.omega);
  return out;
}

JointRow offset_row(const JointSides& s, const Vec3& u) {
  const Vec3 d = s.b.anchor() - s.a.anchor();
  const Vec3 d_rate = s.b.anchor_velocity() - s.a.anchor_velocity();
  const Vec3 u_rate = s.a.omega.cross(u);
  JointRow out;
  out.row = point_row(s.a.block, s.a.arm + d, s.b.block, s.b.arm, u);
  out.error = u.dot(d);
  // u'' d + 2 u' d' + u d'', each at constant v and omega.
  out.bias = s.a.omega.cross(u_rate).dot(d) + 2 * u_rate.dot(d_rate) +
             u.dot(s.b.anchor_bias() - s.a.anchor_bias());
  return out;
}

}  // namespace tumble
