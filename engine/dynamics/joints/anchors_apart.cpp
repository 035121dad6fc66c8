#include "engine/dynamics/joints/joint_part.hpp"

namespace tumble {

void anchors_apart(const JointSides& s, JointRows& out) {
  const Vec3 d = s.b.anchor() - s.a.anchor();
  const Vec3 d_rate = s.b.anchor_velocity() - s.a.anchor_velocity();
  const double distance = d.norm();
  const Vec3 n = distance > 0 ? Vec3(d / distance) : Vec3(s.a.axes.col(2));
  const double rate = n.dot(d_rate);
  JointRow row;
  row.row = point_row(s.a.block, s.a.arm, s.b.block, s.b.arm, n);
  row.error = distance - s.length;
  row.bias = n.dot(s.b.anchor_bias() - s.a.anchor_bias());
  // What moves across the line bends it.
  if (distance > 0) row.bias += (d_rate.squaredNorm() - rate * rate) / distance;
  out.push_back(row);
}

}  // namespace tumble
