#pragma once
#include "engine/scene/reader.hpp"

#include <filesystem>

namespace tumble {

/// The scene for a bare robot file (URDF, MJCF): the robot is placed as in the file, with z turned
/// up, held by motors, on a floor if the file has none, with a camera that sees it whole. It is
/// `robots.robot` of the scene, so that `--set robots.robot.base=floating` works, and its parts
/// have the file's names. Faults: the file cannot be read as a robot.
SceneRead robot_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace tumble
