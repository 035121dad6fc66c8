#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/geometry/debug_draw.hpp"

namespace tumble {

/// A colour for each level of a grid or depth of a tree; neighbours differ, and they come again
/// after eight.
Vec4f level_colour(size_t level);

/// Draws, once each, the cells of edge `edge` [m] that the bounds of these proxies reach into.
void draw_cells(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
                double edge, const Vec4f& colour, DebugDraw& out);

}  // namespace tumble
