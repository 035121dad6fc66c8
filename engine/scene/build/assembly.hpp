#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Moves the bodies of a scene that joints tie, and changes their velocities, so that the joints,
/// their hard limits and couplings hold: positions by Newton's method, each step of which is the
/// least in the metric of mass that closes the joints to first order (Articulation::close), halved
/// until it brings them nearer; velocities by the least change in the same metric. What nothing
/// moves stays. What moved is told in BuiltScene::assembly. Bodies that fit keep their bits.
/// Gives what is left open, where there is no such place near: path in the scene and sentence; then
/// nothing is moved.
std::vector<std::pair<std::string, std::string>> assemble(BuiltScene& built);

}  // namespace tumble
