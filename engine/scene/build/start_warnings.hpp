#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// What is probably not meant about a world at its start, a sentence each, which names the thing,
/// the numbers and the cure: rods whose ends are not as far apart as their length, springs from a
/// point to itself, bodies that begin far below the ground, bodies out of all proportion to the
/// others, what particle_warnings() finds, and values without effect.
std::vector<std::string> start_warnings(const BuiltScene& built);

}  // namespace tumble
