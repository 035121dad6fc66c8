#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Moves the bodies of a scene that joints tie, and changes their velocities, so that the joints,
/// their hard limits and couplings hold, by as little as possible in the metric of mass
/// (LeastMotion). Newton's method leads to a state that fits, each step of it halved until it
/// brings the bodies nearer; from there they go back towards where they stood as far as joints and
/// limits allow. Velocities change by the least in the same metric. What nothing moves stays. What
/// moved is told in BuiltScene::assembly. Bodies that fit keep their bits.
/// Gives what is left open, where there is no such place near: path in the scene and sentence; then
/// nothing is moved.
std::vector<std::pair<std::string, std::string>> assemble(BuiltScene& built);

}  // namespace tumble
