#include "engine/dynamics/joints/joint_algebra.hpp"

namespace tumble {

JointRow* anchors_apart(const JointSides& s, JointRow* out) {
  *out = distance_row(s);
  out->error -= s.length;
  return out + 1;
}

}  // namespace tumble
