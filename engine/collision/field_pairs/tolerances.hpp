#pragma once

/// The numbers of this folder that no option gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// A piece of an edge this long [cells] is not divided further where the least distance along it
/// is looked for: a field has no finer shape than its cells, and ends its band two cells away.
inline constexpr double edge_piece = 2;

/// Along an edge the distance counts as level where it changes by less than this per length [-]:
/// about a degree, above what storage in 16 bits makes of a flat face (1e-6 diagonals a node), and
/// below any tilt at which one end alone would press.
inline constexpr double level_slope = 0.02;

/// Halvings of a piece of an edge in the search for its lowest place: to a 500th of a cell, less
/// than the error between nodes by far.
inline constexpr int edge_halvings = 10;

/// Sine of the angle by which the surface around a corner may reach past it towards the field: in
/// front of the field as for triangles (mesh_pairs), and more inside, where what reaches past it
/// has contacts too.
inline constexpr double cone_in_front = 0.3, cone_inside = 0.6;

/// An edge touches with its outside where the field's normal looks against the edge's with this
/// cosine at least: edges that lie along each other do so across, and touch by their faces.
inline constexpr double edge_outside = 0.2;

/// A face lies on the field where its normal and the field's are opposite up to the angle of this
/// cosine: about 10 degrees, as for one manifold (mesh_pairs/patches).
inline constexpr double face_to_face = 0.985;

/// Where a round shape meets a field the search starts in every cube of half this many inner radii
/// of the shape that holds points of both [-]: the walls of a groove that a ball touches are
/// farther apart than that.
inline constexpr double start_of_radius = 0.5;

/// Cubes have at least this half side [cells], for a field has no finer shape.
inline constexpr double least_start = 0.5;

/// No part of a round shape is deeper than the deepest point that is found by more than this
/// [cells]: what a field of exact nodes may err by within a cell is three times as much.
inline constexpr double deepest = 0.25;

/// No more cubes than this along the longest side of what a shape and a field share: a long thin
/// shape has larger ones.
inline constexpr double most_starts_along = 64;

/// Steps of the search for the deepest point of a round shape, and by how much a step that leads
/// up is shortened. From a plane one step is enough; near a sharp edge each step halves the error.
inline constexpr int most_descents = 40;
inline constexpr double shorter_step = 0.25;

/// The search has arrived where it moves less than this [inner radii]; its error in depth is of
/// second order in it: a millionth of the radius, below what the field itself errs.
inline constexpr double arrived = 1e-3;

/// Two searches that end this near each other [inner radii] have found the same: a few times what
/// they stop short by.
inline constexpr double same_place = 4e-3;

/// A deepest point adds to the corners of the face that touches only if it is lower by this
/// [cells].
inline constexpr double clearly_lower = 1e-3;

/// A gradient shorter than this has no direction: on a ridge of the distance, as far from one side
/// as from the other.
inline constexpr double no_gradient = 0.1;

/// Of the contacts of one pair this many, the deepest, are made into manifolds: all of the corners
/// that a fine mesh may have within the margin would not press harder.
inline constexpr unsigned most_contacts = 256;

}  // namespace tumble::tolerances
