#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

void anchor_on_line(const JointSides& s, JointRows& out) {
  for (int k = 0; k < 2; ++k) out.push_back(offset_row(s, s.a.axes.col(k)));
}

}  // namespace tumble
