#pragma once
#include "engine/scene/robot_files/robot_base.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

namespace tumble {

/// A rigid body of a robot: a link with everything that is welded to it, in its frame.
struct RobotBody {
  std::string name;
  RobotPlace at;
  MassProperties mass;
  std::vector<RobotGeometry> collides, drawn;
  size_t parent = RobotLink::world;
  Pose in_parent;                  ///< as the file places it
  std::vector<RobotJoint> joints;  ///< from the parent on
  bool floating = false;
  bool fixed = false;  ///< to the world
  Pose start;          ///< in the file's world (z up)
};

/// A link as part of a body; of the world where that is RobotLink::world.
struct LinkPlace {
  size_t body = RobotLink::world;
  Pose in_body;
};

struct RobotBodies {
  std::vector<RobotBody> bodies;  ///< parents first
  std::vector<LinkPlace> links;   ///< by link of the model
};

/// Makes one body of links that are welded to each other; a link without mass hands its joints on
/// to the one link that hangs on it by joints, or else is welded to its parent, with a warning.
RobotBodies join_welded(const RobotModel& model, RobotBase base, RobotLog& log);

}  // namespace tumble
