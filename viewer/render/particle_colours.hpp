#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/colour_map.hpp"

namespace tumble {

/// The range of values for colouring particles by a quantity.
NiceScale colour_scale(const ParticleFrame& particles);

}  // namespace tumble
