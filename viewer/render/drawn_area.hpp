#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/render_scene.hpp"

#include <optional>

namespace tumble {

/// The least rectangle of pixels that holds all bodies and particles of the scene, by their boxes:
/// what lies outside is ground and sky. Nothing where none is in the picture.
std::optional<ScissorRect> drawn_area(const RenderScene& scene, const ViewSetup& view);

}  // namespace tumble
