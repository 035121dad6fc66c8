#pragma once
#include "engine/scene/workloads/end_state.hpp"

namespace tumble {

/// Overlaps of tori (dynamic bodies) with each other and with their ground, whatever shapes the
/// bodies have: of 24 x 12 points of each torus, the depth of the deepest one below the ground
/// (vertically, 2 m at most) and inside each near torus. Both are the smooth ones: a mesh of 24 x
/// 12 squares that just touches another may show up to 13 mm, and up to 8 mm on the ground, where
/// the flat triangles leave the smooth surface.
OverlapDepths tori_overlaps(const ToriOnTerrain& tori, std::span<const RigidBody> bodies);

}  // namespace tumble
