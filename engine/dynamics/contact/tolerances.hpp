#pragma once
#include <cstddef>

/// Constants of this folder that are no settings: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Relative motion of two shapes up to which their contacts are carried along, as a share of their
/// margin [-]. The error of a gap is of second order in it; contacts at rest need not be found
/// anew, and the narrow phase runs after few ticks where bodies move.
inline constexpr double carried_of_margin = 0.02;
/// Share of the margin within which contacts of two triangulated surfaces are foreseen [-]: each
/// triangle within it costs time. How far the surfaces may approach in the tick is added in full.
inline constexpr double triangles_of_margin = 0.25;

/// How far the list of near shapes of two bodies reaches, in multiples of the search range of
/// contacts, plus one margin [-]: the list is made anew when the bodies have moved by the spare
/// range.
inline constexpr double list_of_reach = 2;

/// Widening of a box before it is compared with the leaves of a mesh's tree, which are in single
/// precision, as a share of the mesh's size [-].
inline constexpr double leaf_of_size = 1e-6;

/// Weight of a point at the margin in the mean normal of a shared manifold, relative to the deepest
/// point [-]: keeps the sum of weights above zero.
inline constexpr double least_weight = 1e-3;
/// The same where all points are at the margin [m].
inline constexpr double least_depth = 1e-12;
/// Cosine of the greatest angle (10 degrees) between normals of manifolds of two bodies that are
/// merged [-]; the same as for patches of meshes.
inline constexpr double shared_normal = 0.985;
/// How far a point may be outside of the polygon that the kept points span, as a share of the
/// extent of all points [-]. Of a ring eight points are kept, whose chords are 0.04 of its diameter
/// inside the circle.
inline constexpr double left_out_of_extent = 0.1;

/// Cosine of the greatest angle (26 degrees) between the normals of an old contact and a new one
/// that continues it at the same place [-]. A body that tips over an edge changes its normal by
/// more, and its new contact starts without forces.
inline constexpr double same_normal = 0.9;
/// Greatest distance of an old point and the new one that continues it, as a share of the smaller
/// body's radius [-]: less than the distance between points of a face, more than a contact rolls in
/// a tick.
inline constexpr double same_place_of_radius = 0.1;

/// Contacts for which memory is cleared at once [-]: tens of megabytes, after each of which a
/// request to stop is obeyed.
inline constexpr size_t room_at_once = 1 << 16;
/// How many pairs ahead the lists of contacts are prefetched [-]; see bodies_ahead.
inline constexpr size_t pairs_ahead = 4;

}  // namespace tumble::tolerances
