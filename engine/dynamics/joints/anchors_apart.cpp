#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

void anchors_apart(const JointSides& s, JointRows& out) {
  JointRow row = distance_row(s);
  row.error -= s.length;
  out.push_back(row);
}

}  // namespace tumble
