#include "engine/dynamics/joints/joint_coordinate.hpp"
#include "engine/dynamics/joints/tolerances.hpp"

namespace tumble {

// B swings about n = z_a x z_b / |z_a x z_b|. Where the axes are parallel there is no such
// direction; then it is any across them.
JointRow swing_angle(const JointSides& s) {
  const Vec3 za = s.a.axes.col(2), zb = s.b.axes.col(2);
  const Vec3 across = za.cross(zb);
  const double sine = across.norm();
  const Vec3 relative = s.b.omega - s.a.omega;
  JointRow out;
  out.error = std::atan2(sine, za.dot(zb));
  Vec3 n = s.a.axes.col(0);
  if (sine > tolerances::parallel_axes) {
    n = across / sine;
    const Vec3 across_rate = s.a.omega.cross(za).cross(zb) + za.cross(s.b.omega.cross(zb));
    const Vec3 n_rate = (across_rate - n.dot(across_rate) * n) / sine;
    out.bias = n_rate.dot(relative);
  }
  out.row.a = {s.a.block, Vec3::Zero(), -n};
  out.row.b = {s.b.block, Vec3::Zero(), n};
  return out;
}

}  // namespace tumble
