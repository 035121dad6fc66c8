#pragma once
#include "engine/world/microscope/sketch.hpp"

namespace tumble {

/// Linear colour of a kind of ink for sketches drawn in the scene, where the background is light.
Vec3f ink_in_world(Ink ink);
/// The same for diagrams, whose background is dark: sRGB bytes, red lowest.
uint32_t ink_on_plate(Ink ink, float opacity = 1);

}  // namespace tumble
