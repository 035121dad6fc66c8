#pragma once
#include "engine/scene/workloads/end_state.hpp"

namespace tumble {

/// Overlaps of tori (dynamic bodies) with each other and with their ground, independently of the
/// shapes that the bodies have: for sample points of each torus, the greatest depth below the
/// ground (vertically, at most 2 m) and inside each torus nearby. Smooth tori are sampled at 24 x
/// 12 points. If they are meshes, the samples are vertices, midpoints of edges and centroids of
/// triangles, and depths are measured in the faceted solids: measured in the smooth torus, meshes
/// of 24 x 12 squares that just touch would seem to overlap by up to 13 mm, and by 8 mm with the
/// ground.
OverlapDepths tori_overlaps(const ToriOnTerrain& tori, std::span<const RigidBody> bodies);

}  // namespace tumble
