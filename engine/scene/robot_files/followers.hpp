#pragma once
#include "engine/scene/description/joint.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

#include <map>
#include <string>
#include <vector>

namespace tumble {

/// Starts those coordinates that follow others (mimic, linear equality of joints) where these put
/// them. Warns of those that cannot follow, which then move by themselves: of unknown joints and
/// balls, and of joints that follow each other in a circle.
void start_followers(RobotModel& model, RobotLog& log);

/// Which coordinates of a scene's joints those of a file are, and the couplings of those that
/// follow others.
class RobotFollowers {
 public:
  /// A coordinate in the scene: of a joint by its name, "" for its only one.
  struct Place {
    std::string joint, coordinate;
    double zero = 0;  ///< the file's value where the scene's is 0 [m] or [rad]
  };
  void put(const RobotJoint& joint, Place place);
  /// Couples what was put.
  void couple(NamedList<JointDescription>& joints, RobotLog& log) const;

 private:
  struct Follower {
    RobotJoint joint;
    Place place;
  };
  std::map<std::string, Place> places_;  ///< by the file's names
  std::vector<Follower> followers_;
};

}  // namespace tumble
