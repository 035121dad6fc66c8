#include "engine/dynamics/joints/joint_algebra.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"

namespace tumble {

JointRow offset_x(const JointSides& s) {
  return offset_row(s, s.a.axes.col(0));
}
JointRow offset_y(const JointSides& s) {
  return offset_row(s, s.a.axes.col(1));
}
JointRow offset_z(const JointSides& s) {
  return offset_row(s, s.a.axes.col(2));
}

}  // namespace tumble
