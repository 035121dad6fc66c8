#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

namespace tumble {

/// Replaces `pairs` by the pairs of triangles (a of A, b of B) that may be within `reach` [m] of
/// each other, in ascending order. With `kind` null they are found by the boxes that every mesh
/// has: pairs whose boxes are within reach, and of which neither is beyond reach on one side of the
/// other's plane. Otherwise they are found by hierarchies of that kind: exactly the pairs within
/// reach. Returns false, with only some of the pairs, if there are more than `most`. If there are
/// none, `apart` receives a lower bound on the distance of all triangles [m], at least `reach`.
/// `crossing` receives those of the pairs that may cross, or would if B moved by less than a
/// millionth of the sizes of both. `by_b` receives the same pairs as (b, a), in ascending order.
bool near_triangles(const PlacedSurface& A, const PlacedSurface& B, double reach, size_t most,
                    const HierarchyKind* kind, std::vector<TriangleIds>& pairs,
                    double* apart = nullptr, std::vector<TriangleIds>* crossing = nullptr,
                    std::vector<TriangleIds>* by_b = nullptr);

}  // namespace tumble
