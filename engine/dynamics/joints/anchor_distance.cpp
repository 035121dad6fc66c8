#include "engine/dynamics/joints/joint_algebra.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"

namespace tumble {

JointRow anchor_distance(const JointSides& s) {
  return distance_row(s);
}

}  // namespace tumble
