#pragma once
#include "engine/scene/robot_files/robot_base.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

namespace tumble {

/// A rigid body of a robot: a link with everything welded to it, in the link's frame.
struct RobotBody {
  std::string name;
  RobotPlace at;
  MassProperties mass;
  std::vector<RobotGeometry> collides, drawn;
  size_t parent = RobotLink::world;
  Pose in_parent;                  ///< as the file places it
  std::vector<RobotJoint> joints;  ///< in order from the parent
  bool floating = false;
  bool fixed = false;  ///< to the world
  Pose start;          ///< in the file's world (z up)
};

/// Where a link is: its body, or the world (RobotLink::world), and its pose there.
struct LinkPlace {
  size_t body = RobotLink::world;
  Pose in_body;
};

struct RobotBodies {
  std::vector<RobotBody> bodies;  ///< parents first
  std::vector<LinkPlace> links;   ///< by link of the model
};

/// Merges links that are welded to each other into one body each. A link without mass passes its
/// joints on to the only link attached to it by joints; otherwise it is welded to its parent, with
/// a warning.
RobotBodies join_welded(const RobotModel& model, RobotBase base, RobotLog& log);

}  // namespace tumble
