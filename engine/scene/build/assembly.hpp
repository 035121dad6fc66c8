#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Moves the jointed bodies of a scene, and changes their velocities, so that the joints, their
/// hard limits and couplings are satisfied: positions by Newton's method, where each step is the
/// smallest in the mass metric that satisfies the linearised constraints (Articulation::close),
/// halved until the error decreases; velocities by the smallest change in the same metric. Fixed
/// bodies stay. Moved bodies are reported in BuiltScene::assembly. Bodies that already fit keep
/// their bits. Returns what remains unsatisfied if no solution is found nearby, as paths in the
/// scene and messages; nothing is moved then.
std::vector<std::pair<std::string, std::string>> assemble(BuiltScene& built);

}  // namespace tumble
