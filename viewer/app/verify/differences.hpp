#pragma once
#include "engine/core/result.hpp"
#include "viewer/ui/comparison.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

struct SceneDescription;

// The differences between two worlds of one scene, for `tumble verify` and the panel Compare.

/// All differences in order of declaration: settings, numbers of the scene, threads and instruction
/// set.
std::vector<WorldDifference> differences(const WorldChoice& a, const WorldChoice& b);
/// The overrides "path=value" with which A's scene is opened as B; differences that do not belong
/// to a scene are left out.
std::vector<std::string> overrides_of(std::span<const WorldDifference> differences);
/// Names of the settings that differ, as in scene files and panels.
std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b);
/// Titles of world A and world B by their differences: "event" and "realtime", "gravity 0 -1.6 0"
/// ...; of many differences the first two. Both empty if there are none.
std::pair<std::string, std::string> names_by(std::span<const WorldDifference> differences);

/// The numbers that a scene declares, with their values.
std::vector<std::pair<std::string, double>> numbers_of(const SceneDescription& scene);
/// Moves "threads=N" and "simd=NAME" from a list of "path=value" into the choice. Error: an invalid
/// value.
Status take_machine(std::vector<std::string>& overrides, WorldChoice& choice);

}  // namespace tumble
