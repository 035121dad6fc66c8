#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Contradictions in the couplings of joint coordinates: cycles of couplings that are inconsistent,
/// and motors of unlimited strength whose rates the couplings do not allow together. Path in the
/// scene and message of each.
std::vector<std::pair<std::string, std::string>> coupling_faults(const BuiltScene& built);

}  // namespace tumble
