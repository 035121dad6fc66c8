#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Probable mistakes in a world at its start, a message for each, with names, numbers and cure:
/// rods whose ends are not at the distance of their length, springs from a point to itself, bodies
/// that start far below the ground, bodies much larger or smaller than all others, what
/// particle_warnings() finds, and values without effect.
std::vector<std::string> start_warnings(const BuiltScene& built);

}  // namespace tumble
