#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

namespace tumble {

/// Replaces `pairs` by the triangles (a of A, b of B) that may be within `reach` [m] of each other,
/// ascending: their boxes are that near, and neither lies wholly farther than that on one side of
/// the other's plane. False, and only some of the pairs, when there are more than `most`.
bool near_triangles(const PlacedSurface& A, const PlacedSurface& B, double reach, size_t most,
                    std::vector<TriangleIds>& pairs);

}  // namespace tumble
