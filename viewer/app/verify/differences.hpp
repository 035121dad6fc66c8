#pragma once
#include "engine/world/settings.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Names of the settings in which two worlds differ, as the scene file and the panel have them.
std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b);

/// What world A and world B are called by that: "event" and "realtime", "gravity 0 -1.6 0" ...; of
/// many differences the first two. Both empty where they are equal.
std::pair<std::string, std::string> names_by_settings(const WorldSettings& a,
                                                      const WorldSettings& b);

}  // namespace tumble
