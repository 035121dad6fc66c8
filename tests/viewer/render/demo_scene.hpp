#pragma once
#include "viewer/render/render_scene.hpp"

namespace tumble::test {

/// A round tower of bricks with `count` bodies in and around it, without marks; the same on every
/// machine.
RenderScene demo_scene(int count = 200);

/// Adds one of everything else: lines, points, text, particles, a ghost, a panel, a selection.
void add_marks(RenderScene& scene);

/// A pool of a liquid with waves and foam, a box half in it, smoke over it, and a legend.
RenderScene soft_scene();

}  // namespace tumble::test
