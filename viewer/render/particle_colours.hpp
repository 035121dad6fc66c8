#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/colour_map.hpp"

namespace tumble {

/// The scale of the colours by which particles tell a quantity.
NiceScale colour_scale(const ParticleFrame& particles);

}  // namespace tumble
