#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/robot_files/asset_paths.hpp"
#include "engine/scene/robot_files/robot_model.hpp"

#include <map>

namespace tumble {

struct RobotOptions {
  std::string prefix{};  ///< of all names
  Pose pose{};           ///< of the file's world in the scene, before z is turned up
  RobotBase base = RobotBase::file;
  RobotMotors motors = RobotMotors::hold;
  bool self_collision = true;
  int group = 0;  ///< for links that do not collide with each other
  /// Coordinates by the file's names: at the start, and where motors pull them [rad], [m].
  std::map<std::string, double> start{}, target{};
};

/// Bodies, joints and meshes of a robot, for a scene to take in.
struct RobotParts {
  SceneDescription scene;
  std::map<std::string, int> lines;  ///< in the robot's file, by "bodies.NAME"
  Aabb bounds;                       ///< of all but planes, at the start
  bool has_ground = false;           ///< a plane of its own
};

/// Whether a file is read as a robot: by its ending .urdf, .urdf.gz or .mjcf, an .xml by its root.
bool is_robot_file(const std::filesystem::path& file);
/// Reads URDF or MJCF, by the root element.
RobotModel read_robot_file(const std::filesystem::path& file, const PackageFolders& packages,
                           RobotLog& log);

/// Turns the z axis of robot files up: the pose of their world in Tumble's.
Pose z_up();

/// The links become bodies in the frames that their file gives them, turned so that its z points
/// up; chains of coordinates become joints (joint_stages), with a body of a small share of the
/// link's mass between two of them. Faults: starts that name no joint or are beyond its limits.
RobotParts make_robot(RobotModel model, const RobotOptions& options, RobotLog& log);

}  // namespace tumble
