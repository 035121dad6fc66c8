#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Pair potentials with which atoms of a crystal oscillate too fast for the tick: a message for
/// each, with its name and a sufficient tick.
std::vector<std::string> pair_limit_warnings(const BuiltScene& built);

}  // namespace tumble
