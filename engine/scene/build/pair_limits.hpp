#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Pair potentials under which atoms of a crystal oscillate too fast for the tick: a sentence for
/// each, with its name and the tick that holds it.
std::vector<std::string> pair_limit_warnings(const BuiltScene& built);

}  // namespace tumble
