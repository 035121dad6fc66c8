#pragma once
#include "engine/scene/robot_files/robot_bodies.hpp"

#include <utility>
#include <vector>

namespace tumble {

/// Pairs of bodies of one tree of joints whose colliding shapes overlap or touch at the start, each
/// with the lower first. Meshes count as their hulls.
std::vector<std::pair<size_t, size_t>> start_overlaps(const std::vector<RobotBody>& bodies);

}  // namespace tumble
