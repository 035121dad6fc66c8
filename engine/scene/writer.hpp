#pragma once
#include "engine/scene/description.hpp"

#include <string>

namespace tumble {

/// The text of a scene file that reads back as this description. Values that are the defaults are
/// left out; numbers are written so that they read back with the same bits.
std::string write_scene(const SceneDescription& scene);

}  // namespace tumble
