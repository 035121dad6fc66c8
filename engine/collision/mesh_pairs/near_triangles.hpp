#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

namespace tumble {

/// Replaces `pairs` by the triangles (a of A, b of B) that may be within `reach` [m] of each other,
/// ascending. With `kind` null, found by the boxes that every mesh has: pairs whose boxes are that
/// near, neither wholly farther than that on one side of the other's plane. Else by hierarchies of
/// that kind: the pairs that really are that near. False, and only some of the pairs, when there
/// are more than `most`. Where there are none, all triangles are at least `apart` [m] from each
/// other, which is `reach` at least. `crossing`: of the pairs those that may cross, or do once B is
/// moved by less than a millionth of the sizes of both. `by_b`: the same pairs as (b, a),
/// ascending.
bool near_triangles(const PlacedSurface& A, const PlacedSurface& B, double reach, size_t most,
                    const HierarchyKind* kind, std::vector<TriangleIds>& pairs,
                    double* apart = nullptr, std::vector<TriangleIds>* crossing = nullptr,
                    std::vector<TriangleIds>* by_b = nullptr);

}  // namespace tumble
