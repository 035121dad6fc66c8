#pragma once

/// The constants of this folder that no option gives, with unit, reason, and source where there is
/// one.
namespace tumble::tolerances {

/// A piece of an edge no longer than this [cells] is not divided further in the search for the
/// least distance along it: a field has no detail finer than its cells, and its band ends two cells
/// away.
inline constexpr double edge_piece = 2;

/// The distance along an edge counts as constant if it changes by less than this per length [-]:
/// about a degree, above the noise of storage in 16 bits on a flat face (1e-6 diagonals a node),
/// and below any tilt at which one end alone would press.
inline constexpr double level_slope = 0.02;

/// Bisections of a piece of an edge in the search for its lowest point: to a 500th of a cell, far
/// less than the interpolation error between nodes.
inline constexpr int edge_halvings = 10;

/// Sine of the angle by which the surface around a corner may reach past it towards the field: for
/// a corner outside the field, as for triangles (mesh_pairs); for one inside more, since the parts
/// that reach past it have contacts too.
inline constexpr double cone_in_front = 0.3, cone_inside = 0.6;

/// An edge touches with its outside only if the cosine between the field's normal and the opposite
/// of the edge's normal is at least this: edges that lie along each other have perpendicular
/// normals, and touch by their faces.
inline constexpr double edge_outside = 0.2;

/// A face lies on the field if the angle between its normal and the opposite of the field's normal
/// has at least this cosine: about 10 degrees, as for one manifold (mesh_pairs/patches).
inline constexpr double face_to_face = 0.985;

/// Half side, in inner radii of a round shape, of the cubes in each of which a search for contacts
/// with a field starts [-]: the walls of a groove that a ball touches are farther apart than that.
inline constexpr double start_of_radius = 0.5;

/// Least half side of these cubes [cells], as a field has no finer detail.
inline constexpr double least_start = 0.5;

/// No part of a round shape is deeper than the deepest point found by more than this [cells]: the
/// interpolation error within a cell of exact nodes may be three times as much.
inline constexpr double deepest = 0.25;

/// Limit of the number of cubes along the longest side of the region that shape and field share; a
/// long thin shape gets larger cubes.
inline constexpr double most_starts_along = 64;

/// Limit of the steps of a descent to the deepest point of a round shape, and the factor by which a
/// step that ascends is shortened. On a plane one step is enough; near a sharp edge each step
/// halves the error.
inline constexpr int most_descents = 40;
inline constexpr double shorter_step = 0.25;

/// A descent ends when a step is shorter than this [inner radii]; its error in depth is of second
/// order in the step, a millionth of the radius, which is less than the field's own error.
inline constexpr double arrived = 1e-3;

/// Two descents that end within this distance [inner radii] have found the same minimum: it is a
/// few times the error at which they end.
inline constexpr double same_place = 4e-3;

/// A deepest point is added to the corners of the face that touches only if it is lower than them
/// by this [cells].
inline constexpr double clearly_lower = 1e-3;

/// A gradient shorter than this has no direction: the point is equally far from two sides.
inline constexpr double no_gradient = 0.1;

/// Manifolds are made of at most so many contacts of a pair, the deepest ones: a fine mesh may have
/// more corners within the margin, which would not change the forces.
inline constexpr unsigned most_contacts = 256;

}  // namespace tumble::tolerances
