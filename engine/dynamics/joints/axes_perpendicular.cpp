#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

void axes_perpendicular(const JointSides& s, JointRows& out) {
  out.push_back(dot_row(s, s.a.axes.col(2), s.b.axes.col(0)));
}

}  // namespace tumble
