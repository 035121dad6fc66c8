#include "engine/dynamics/joints/joint_part.hpp"

namespace tumble {

JointRow* anchors_together(const JointSides& s, JointRow* out) {
  const Vec3 error = s.b.anchor() - s.a.anchor();
  const Vec3 bias = s.b.anchor_bias() - s.a.anchor_bias();
  for (int k = 0; k < 3; ++k, ++out) {
    put_point_row(s.a.block, s.a.arm, s.b.block, s.b.arm, Vec3::Unit(k), out->row);
    out->error = error[k];
    out->bias = bias[k];
  }
  return out;
}

}  // namespace tumble
