#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Probable mistakes in the particles, emitters and sinks of a world at its start, a message for
/// each, with names, place and cure: particles at the same place, births inside bodies, sinks that
/// contain everything, periodic boxes that do not fit, emitters that emit nothing, liquids whose
/// speed of sound is too low.
std::vector<std::string> particle_warnings(const BuiltScene& built);

}  // namespace tumble
