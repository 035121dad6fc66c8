#include "engine/dynamics/joints/joint_coordinate.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>

namespace tumble {

// With q = (w, x, y, z) for the rotation from A's frame to B's the twist is 2 atan2(z, w), and
// w^2 + z^2 = (1 + z_a.z_b) / 2.
JointRow twist_angle(const JointSides& s) {
  const Quat q = s.a.q.conjugate() * s.b.q;
  const Vec3 za = s.a.axes.col(2), zb = s.b.axes.col(2);
  const Vec3 za_rate = s.a.omega.cross(za), zb_rate = s.b.omega.cross(zb);
  const double width = std::max(1 + za.dot(zb), tolerances::opposite_axes);
  const double width_rate = za_rate.dot(zb) + za.dot(zb_rate);
  const Vec3 turn = (za + zb) / width;
  const Vec3 turn_rate = (za_rate + zb_rate - width_rate * turn) / width;
  JointRow out;
  out.row.a = {s.a.block, Vec3::Zero(), -turn};
  out.row.b = {s.b.block, Vec3::Zero(), turn};
  out.error = 2 * std::atan2(q.z(), q.w());
  out.bias = turn_rate.dot(s.b.omega - s.a.omega);
  return out;
}

}  // namespace tumble
