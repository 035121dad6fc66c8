#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/robot_files/asset_paths.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

#include <map>

namespace tumble {

struct RobotOptions {
  std::string prefix{};  ///< prepended to all names
  Pose pose{};           ///< of the file's world in the scene, before z is turned up
  RobotBase base = RobotBase::file;
  RobotMotors motors = RobotMotors::hold;
  bool self_collision = true;
  int group = 0;  ///< for links that do not collide with each other
  /// Coordinates by the file's names: initial values, and targets of motors [rad], [m].
  std::map<std::string, double> start{}, target{};
};

/// Bodies, joints and meshes made from a robot, to be added to a scene.
struct RobotParts {
  SceneDescription scene;
  std::map<std::string, int> lines;  ///< in the robot's file, by "bodies.NAME"
  Aabb bounds;                       ///< of all but planes, at the start
  bool has_ground = false;           ///< it contains a plane
};

/// Whether a file is a robot: by its ending .urdf, .urdf.gz or .mjcf, and for .xml by its root
/// element.
bool is_robot_file(const std::filesystem::path& file);
/// Reads URDF or MJCF, by the root element.
RobotModel read_robot_file(const std::filesystem::path& file, const PackageFolders& packages,
                           RobotLog& log);

/// The pose of the files' world in Tumble's: rotates the z axis up.
Pose z_up();

/// The links become bodies in the frames that their file gives them, rotated so that its z points
/// up; chains of coordinates become joints (joint_stages), with an auxiliary body, of a small share
/// of the link's mass, between two of them. Faults: start values for unknown joints or beyond
/// limits.
RobotParts make_robot(RobotModel model, const RobotOptions& options, RobotLog& log);

}  // namespace tumble
