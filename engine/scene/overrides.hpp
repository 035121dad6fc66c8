#pragma once
#include "engine/scene/json_tree.hpp"

#include <string>

namespace tumble {

/// Applies "path=value" to the tree of a scene file. The value is JSON, or else taken as a string.
/// Faults carry the file name "--set" and the path.
void apply_override(JsonNode& root, const std::string& assignment, FaultList& faults);

}  // namespace tumble
