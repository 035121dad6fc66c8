#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/render_scene.hpp"

#include <vector>

namespace tumble {

/// Few disjoint rectangles [px], on the coarse raster of CellRaster, that contain the bounding
/// boxes of all bodies and particles; outside of them there is only ground and sky. Empty if
/// nothing is in view.
std::vector<ScissorRect> drawn_parts(const RenderScene& scene, const ViewSetup& view);

/// Likewise, rectangles that contain everything that reaches so far below the ground that it would
/// be visible if the ground did not hide it.
std::vector<ScissorRect> sunken_parts(const RenderScene& scene, const ViewSetup& view);

}  // namespace tumble
