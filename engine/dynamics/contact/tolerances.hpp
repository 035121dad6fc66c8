#pragma once
#include <cstddef>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Motion of two shapes against each other, of their margin, while their contacts are carried along
/// [-]. The error of a gap is of second order in it; contacts between bodies at rest need not be
/// found anew, and what moves is looked at after few ticks.
inline constexpr double carried_of_margin = 0.02;
/// Share of the margin that is looked at between two surfaces of triangles [-]: each triangle
/// within it costs time. What they travel in the tick is added and counts in full.
inline constexpr double triangles_of_margin = 0.25;

/// How far shapes of two bodies are listed as near each other, of how far contacts are looked for,
/// beside a margin [-]: the list is made anew when the bodies have moved by what it reaches beyond.
inline constexpr double list_of_reach = 2;

/// What a box is widened by before it is looked for among the single-precision leaves of a mesh's
/// tree, of the mesh's size [-].
inline constexpr double leaf_of_size = 1e-6;

/// What a point at the margin weighs in the mean of the normals of a shared manifold, of what the
/// deepest does [-]: no mean is of nothing.
inline constexpr double least_weight = 1e-3;
/// The same where all points are at the margin [m].
inline constexpr double least_depth = 1e-12;
/// Cosine of the greatest angle (10 degrees) between the normals of manifolds of two bodies that
/// share their points [-]; the same as of patches of meshes.
inline constexpr double shared_normal = 0.985;
/// How far a point may be outside of what the points that are kept span, of the extent of all [-].
/// A ring keeps eight, whose sides are 0.04 of its diameter inside.
inline constexpr double left_out_of_extent = 0.1;

/// Cosine of the greatest angle (26 degrees) between the normals of an old contact and the new one
/// that continues it at the same place [-]. A body that tips over an edge changes its normal by
/// more, and starts anew.
inline constexpr double same_normal = 0.9;
/// How far apart an old point and the one that continues it may be, of the smaller body's radius
/// [-]: less than the points of a face are from each other, more than a contact rolls in a tick.
inline constexpr double same_place_of_radius = 0.1;

/// Contacts for which room is made at once [-]: tens of megabytes, after which a stop is obeyed.
inline constexpr size_t room_at_once = 1 << 16;
/// How many pairs ahead lists of contacts prefetch [-]; see bodies_ahead.
inline constexpr size_t pairs_ahead = 4;

}  // namespace tumble::tolerances
