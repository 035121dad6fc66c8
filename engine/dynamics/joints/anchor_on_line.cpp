#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow* anchor_on_line(const JointSides& s, JointRow* out) {
  for (int k = 0; k < 2; ++k) *out++ = offset_row(s, s.a.axes.col(k));
  return out;
}

}  // namespace tumble
