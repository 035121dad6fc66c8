#include "engine/scene/robot_scene.hpp"

#include "engine/scene/robot_files/robot_parts.hpp"
#include "engine/scene/writer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double robot_view_deg = 40;

/// A camera that sees the bounding ball, from the robot's front (+x) and its right.
CameraDescription camera_on(const Aabb& bounds) {
  CameraDescription out;
  if (bounds.empty()) return out;
  constexpr double margin = 1.05;
  const double radius = std::max(0.5 * bounds.extent().norm(), 0.01);
  const double half_angle = 0.5 * robot_view_deg * std::numbers::pi / 180;
  out.target = bounds.centre();
  out.position =
      out.target + margin * radius / std::sin(half_angle) * Vec3(1, 0.4, 1.1).normalized();
  out.fov_deg = robot_view_deg;
  return out;
}

SceneDescription scene_around(const RobotModel& model, const RobotParts& parts) {
  SceneDescription scene;
  scene.title = model.name;
  scene.description = fmt::format("The robot of {}; the z axis of its file points up.",
                                  model.file.filename().string());
  RobotDescription& robot = scene.robots.add("robot");
  robot.file = model.file.filename().string();
  robot.prefix = "";
  if (model.gravity) scene.settings.gravity = z_up().direction(*model.gravity);
  if (!parts.has_ground) {
    BodyDescription& floor = scene.bodies.add("floor");
    floor.type = BodyType::fixed;
    floor.shape.emplace().kind = shape_kind(robot_plane());
    if (!parts.bounds.empty()) floor.placement.position.y() = std::min(0.0, parts.bounds.min.y());
  }
  scene.cameras.add("main", camera_on(parts.bounds));
  return scene;
}

}  // namespace

SceneRead robot_scene(const std::filesystem::path& file, const ReadOptions& options) {
  // Read once to find what surrounds it, and again as part of the scene with the overrides.
  RobotLog log;
  const RobotModel model = read_robot_file(file, {}, log);
  RobotParts parts;
  if (log.ok()) parts = make_robot(model, {}, log);
  SceneRead out;
  out.faults = log.faults();
  if (!log.ok()) return out;
  return read_scene(write_scene(scene_around(model, parts)), file.string(), options);
}

}  // namespace tumble
