#pragma once
#include "engine/scene/description/joint.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

#include <span>
#include <string>
#include <vector>

namespace tumble {

/// One joint of Tumble that stands for some of a body's coordinates, in their order.
struct JointStage {
  JointKind kind = JointKind::revolute;
  std::vector<size_t> coordinates;  ///< of the body's joints
  Vec3 anchor = Vec3::Zero();       ///< in the body's frame as the file places it [m]
  Vec3 axis{0, 0, 1};               ///< likewise
  Vec3 axis_b{1, 0, 0};             ///< of a universal joint
  /// Names of the coordinates in JointDescription, as many; "" for the only one.
  std::vector<std::string> names;
};

/// The fewest joints of Tumble with the coordinates of a body: two crossing hinges at right angles
/// are a universal joint; a slide and a hinge along one line, if they start at 0, a cylindrical
/// one; two slides and a hinge across them on which nothing acts, a planar one; any other is by
/// itself. Between two stages there must be a body.
std::vector<JointStage> joint_stages(std::span<const RobotJoint> joints);

/// What acts along a coordinate; `hold`: stiffness and damping of a motor that holds it where it
/// starts, for those without a motor of their own.
struct HoldingGains {
  double stiffness = 0, damping = 0;
};
DriveDescription drive_of_joint(const RobotJoint& joint, const std::optional<HoldingGains>& hold);

}  // namespace tumble
