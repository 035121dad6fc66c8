#pragma once
#include "engine/scene/workloads/end_state.hpp"

namespace tumble {

/// Overlaps of tori (dynamic bodies) with each other and with their ground, whatever shapes the
/// bodies have: of points of each torus, the depth of the deepest one below the ground (vertically,
/// 2 m at most) and inside each near torus. Smooth tori have 24 x 12 points. Where they are meshes,
/// the points are the corners, the middles of edges and the centroids of the triangles, and what
/// they are deep in are the facets: beside the smooth torus, meshes of 24 x 12 squares that just
/// touch would show up to 13 mm, and 8 mm on the ground.
OverlapDepths tori_overlaps(const ToriOnTerrain& tori, std::span<const RigidBody> bodies);

}  // namespace tumble
