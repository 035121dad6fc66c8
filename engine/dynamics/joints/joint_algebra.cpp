#include "engine/dynamics/joints/joint_algebra.hpp"

#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

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

namespace {

/// Velocity of a purely rotational row.
double turn_velocity(const JointSides& s, const JointRow& row) {
  return row.row.b.angular.dot(s.b.omega - s.a.omega);
}

}  // namespace

// With p for the cosine and r for the sine, up to a common factor: d/dt atan2(r, p) =
// (p r' - r p') / (p^2 + r^2).
JointRow direction_row(const JointSides& s, const JointRow& cosine, const JointRow& sine) {
  const double p = cosine.error, r = sine.error;
  const double p_rate = turn_velocity(s, cosine), r_rate = turn_velocity(s, sine);
  const double square = std::max(p * p + r * r, tolerances::opposite_axes);
  const Vec3 turn = (p * sine.row.b.angular - r * cosine.row.b.angular) / square;
  JointRow out;
  out.row.a = {s.a.block, Vec3::Zero(), -turn};
  out.row.b = {s.b.block, Vec3::Zero(), turn};
  out.error = std::atan2(r, p);
  out.bias = (p * sine.bias - r * cosine.bias) / square -
             2 * (p * r_rate - r * p_rate) * (p * p_rate + r * r_rate) / (square * square);
  return out;
}

JointRow distance_row(const JointSides& s) {
  const Vec3 d = s.b.anchor() - s.a.anchor();
  const Vec3 d_rate = s.b.anchor_velocity() - s.a.anchor_velocity();
  const double distance = d.norm();
  const Vec3 n = distance > 0 ? Vec3(d / distance) : Vec3(s.a.axes.col(2));
  const double rate = n.dot(d_rate);
  JointRow row;
  row.row = point_row(s.a.block, s.a.arm, s.b.block, s.b.arm, n);
  row.error = distance;
  row.bias = n.dot(s.b.anchor_bias() - s.a.anchor_bias());
  // Relative motion perpendicular to the line adds a centripetal term.
  if (distance > 0) row.bias += (d_rate.squaredNorm() - rate * rate) / distance;
  return row;
}

}  // namespace tumble
