#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow* anchor_in_plane(const JointSides& s, JointRow* out) {
  *out++ = offset_row(s, s.a.axes.col(2));
  return out;
}

}  // namespace tumble
