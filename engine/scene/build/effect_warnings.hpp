#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Values of a scene that have no effect because of other values: a message for each, with path,
/// reason and cure.
std::vector<std::string> effect_warnings(const BuiltScene& built);

}  // namespace tumble
