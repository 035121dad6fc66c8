#include "engine/dynamics/joints/joint_algebra.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"

namespace tumble {

JointRow first_angle(const JointSides& s) {
  const Vec3 x = s.b.axes.col(0);
  return direction_row(s, dot_row(s, s.a.axes.col(0), x), dot_row(s, s.a.axes.col(1), x));
}

}  // namespace tumble
