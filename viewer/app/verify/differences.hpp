#pragma once
#include "engine/core/result.hpp"
#include "viewer/ui/comparison.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

struct SceneDescription;

// In what two worlds of one scene differ: the one list of `tumble verify` and the panel Compare.

/// Everything in which they do, in the order of declaration: settings, numbers of the scene, how
/// it is computed.
std::vector<WorldDifference> differences(const WorldChoice& a, const WorldChoice& b);
/// What B needs of A's scene to be opened as it is: "path=value" of each that a scene has.
std::vector<std::string> overrides_of(std::span<const WorldDifference> differences);
/// Names of the settings in which two worlds differ, as the scene file and the panel have them.
std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b);
/// What world A and world B are called by their differences: "event" and "realtime", "gravity 0
/// -1.6 0" ...; of many the first two. Both empty where there are none.
std::pair<std::string, std::string> names_by(std::span<const WorldDifference> differences);

/// The numbers that a scene declares, as it has them.
std::vector<std::pair<std::string, double>> numbers_of(const SceneDescription& scene);
/// Takes "threads=N" and "simd=NAME" out of a list of "path=value", into the choice. Error: they
/// have no such value.
Status take_machine(std::vector<std::string>& overrides, WorldChoice& choice);

}  // namespace tumble
