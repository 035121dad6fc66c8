#pragma once
#include "engine/world/settings.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Names of the settings in which two worlds differ, as the scene file and the panel have them.
std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b);

}  // namespace tumble
