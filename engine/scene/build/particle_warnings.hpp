#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// What is probably not meant about the particles, emitters and sinks of a world at its start, a
/// sentence each, which names them, the place and the cure: particles on one place, births inside
/// bodies, sinks that hold all that there is, periodic boxes that do not fit, emitters from which
/// nothing comes, liquids whose sound is too slow.
std::vector<std::string> particle_warnings(const BuiltScene& built);

}  // namespace tumble
