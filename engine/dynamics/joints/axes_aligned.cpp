#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow* axes_aligned(const JointSides& s, JointRow* out) {
  const Vec3 w = s.b.axes.col(2);
  for (int k = 0; k < 2; ++k) put_dot_row(s, s.a.axes.col(k), w, *out++);
  return out;
}

}  // namespace tumble
