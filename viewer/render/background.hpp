#pragma once
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/render_scene.hpp"

#include <cstdint>

namespace tumble {

/// Size of the grid on which the colours of the sky are computed (shaders/sky_grid.glsl).
constexpr uint32_t sky_columns = 24, sky_rows = 32;

/// Whether haze hides the outer edge of the drawn ground: less than 1/255 of the ground's own
/// colour is left there, so the edge cannot be seen.
bool rim_is_hidden(const RenderScene& scene, const FrameSetup& setup);

/// Number of pixel rows, counted from the top of the picture, in which the sky may be seen beyond
/// the ground.
int rows_with_sky(const RenderScene& scene, const FrameSetup& setup);

}  // namespace tumble
