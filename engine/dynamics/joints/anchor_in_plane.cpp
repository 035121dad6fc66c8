#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

void anchor_in_plane(const JointSides& s, JointRows& out) {
  out.push_back(offset_row(s, s.a.axes.col(2)));
}

}  // namespace tumble
