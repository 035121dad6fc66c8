#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// What no motion fulfils of what couples the coordinates of joints: circles of couplings that do
/// not come back to where they began, and motors of any strength that hold rates which couplings do
/// not allow together. Path in the scene and sentence of each.
std::vector<std::pair<std::string, std::string>> coupling_faults(const BuiltScene& built);

}  // namespace tumble
