#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <vector>

namespace tumble {

/// Whether another surface lies behind S, which is only so for an open S; in doubt it does not.
///
/// Every near triangle of the other gives its side: where it is apart from S, that of its point
/// nearest to S, by the pseudo-normal of S there, or none beside a rim; where it crosses S, that of
/// nearly all of it. The other lies behind if all that have a side do. Otherwise it may overlap S
/// from behind, which is taken for granted only if it is convex and its centre is behind the near
/// triangles of S by more than twice what of it is in front. A convex one whose centre is in front
/// of them is never behind.
///
/// `pairs` holds all pairs of triangles within `reach` [m] and perhaps more as (other, S),
/// `swapped` as (S, other), both in ascending order.
bool lies_behind(const PlacedSurface& S, const PlacedSurface& other, bool convex, double reach,
                 const std::vector<TriangleIds>& pairs, const std::vector<TriangleIds>& swapped);

}  // namespace tumble
