#pragma once
#include "engine/scene/json_tree.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Puts bodies, joints and meshes in the place of each of a scene's `robots`, whose files are
/// looked for in the folder of `file` first. What stands there bears the line of its robot; or that
/// of the robot file where `file` is that itself.
void expand_robots(JsonNode& root, const std::string& file, FaultList& faults,
                   std::vector<std::string>& warnings);

}  // namespace tumble
