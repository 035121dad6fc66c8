#pragma once
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/render_scene.hpp"

#include <cstdint>

namespace tumble {

/// Of the grid that the colours of the sky are computed on (shaders/sky_grid.glsl).
constexpr uint32_t sky_columns = 24, sky_rows = 32;

/// Whether the ground ends in haze, so that its rim is no edge: less than a step of 1/255 is left
/// of it there.
bool rim_is_hidden(const RenderScene& scene, const FrameSetup& setup);

/// Rows of pixels from the top down to the last in which the sky may be seen past the ground.
int rows_with_sky(const RenderScene& scene, const FrameSetup& setup);

}  // namespace tumble
