#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow* axes_perpendicular(const JointSides& s, JointRow* out) {
  put_dot_row(s, s.a.axes.col(2), s.b.axes.col(0), *out);
  return out + 1;
}

}  // namespace tumble
