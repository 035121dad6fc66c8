#pragma once
#include "engine/math/types.hpp"

#include <string>
#include <vector>

namespace tumble::test {

/// A body as MuJoCo's own reader makes it, at the start, in its world (z up).
struct MujocoBody {
  std::string name;
  double mass = 0;              ///< [kg]
  Vec3 place = Vec3::Zero();    ///< of its frame [m]
  Vec3 centre = Vec3::Zero();   ///< of mass [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre, in world axes [kg m2]
};
struct MujocoJoint {
  std::string name;
  int kind = 0;                                     ///< 0 free, 1 ball, 2 slide, 3 hinge
  Vec3 anchor = Vec3::Zero(), axis = Vec3::Zero();  ///< in the world
  bool limited = false;
  double lower = 0, upper = 0, stiffness = 0, damping = 0, armature = 0, friction = 0;
};
struct MujocoModel {
  std::vector<MujocoBody> bodies;  ///< but the world
  std::vector<MujocoJoint> joints;
  std::string error;  ///< empty when it was read
};

/// Reads a file by MuJoCo, in a file of its own since its header brings much.
MujocoModel read_by_mujoco(const std::string& file);

}  // namespace tumble::test
