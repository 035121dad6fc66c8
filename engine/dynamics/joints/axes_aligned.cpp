#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

void axes_aligned(const JointSides& s, JointRows& out) {
  for (int k = 0; k < 2; ++k) out.push_back(dot_row(s, s.a.axes.col(k), s.b.axes.col(2)));
}

}  // namespace tumble
