#include "engine/dynamics/joints/joint_algebra.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"

namespace tumble {

// Seen from B, z of A turns backwards.
JointRow second_angle(const JointSides& s) {
  const Vec3 z = s.a.axes.col(2);
  return direction_row(s, dot_row(s, z, s.b.axes.col(2)), dot_row(s, z, s.b.axes.col(1)));
}

}  // namespace tumble
