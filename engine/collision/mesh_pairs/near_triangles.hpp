#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

namespace tumble {

/// Replaces `pairs` by the triangles (a of A, b of B) that may be within `reach` [m] of each other,
/// ascending: their boxes are that near, and neither lies wholly farther than that on one side of
/// the other's plane.
void near_triangles(const PlacedSurface& A, const PlacedSurface& B, double reach,
                    std::vector<TriangleIds>& pairs);

}  // namespace tumble
