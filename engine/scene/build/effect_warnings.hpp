#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Values of a scene that change nothing, because something else that it says leaves them no part:
/// a sentence each with the path, the reason and the cure.
std::vector<std::string> effect_warnings(const BuiltScene& built);

}  // namespace tumble
