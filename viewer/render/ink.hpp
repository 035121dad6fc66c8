#pragma once
#include "engine/world/microscope/sketch.hpp"

namespace tumble {

/// Colours of the meanings of a sketch: linear, for the world, whose ground is light.
Vec3f ink_in_world(Ink ink);
/// sRGB bytes, red lowest, for diagrams, whose ground is dark.
uint32_t ink_on_plate(Ink ink, float opacity = 1);

}  // namespace tumble
