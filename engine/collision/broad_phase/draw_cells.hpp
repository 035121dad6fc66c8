#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/geometry/debug_draw.hpp"

namespace tumble {

/// Colour of a level of a grid or depth of a tree; neighbouring levels differ, and colours repeat
/// after eight.
Vec4f level_colour(size_t level);

/// Draws, once each, the cells of edge `edge` [m] that the bounds of these proxies reach into.
void draw_cells(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
                double edge, const Vec4f& colour, DebugDraw& out);

}  // namespace tumble
