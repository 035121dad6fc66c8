#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/render_scene.hpp"

#include <vector>

namespace tumble {

/// Rectangles of pixels that hold all bodies and particles of the scene, by their boxes: what lies
/// outside is ground and sky. Nothing where none is in the picture. They are few, without
/// overlap, on a coarse raster (CellRaster).
std::vector<ScissorRect> drawn_parts(const RenderScene& scene, const ViewSetup& view);

/// The same of what reaches so far below the ground that one would see it if the ground hid
/// nothing.
std::vector<ScissorRect> sunken_parts(const RenderScene& scene, const ViewSetup& view);

}  // namespace tumble
