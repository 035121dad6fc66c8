#pragma once
#include <cstddef>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// How far from 1 the length of a definition's quaternion may be [-]: three written digits.
inline constexpr double quaternion_length = 1e-3;
/// Rounding of principal moments, relative [-]: that of flat bodies is the sum of the other two.
inline constexpr double principal_moments = 1e-9;
/// Rounding of the entries of an inertia tensor, relative to the greatest [-]: within it a tensor
/// is symmetric, or that of a ball. Ten thousand roundings, as sums over triangles have them.
inline constexpr double inertia_entries = 1e-12;

/// Greatest over least principal moment from which on a body is a needle [-]. Implicit rules for
/// its rotation need sub-steps of the inverse of it [rad]: up to here those that there are.
inline constexpr double needle_moment_ratio = 20;
/// Swing of a needle about its length in one step of its rule [rad]: the energy is then right to a
/// thousandth (second order).
inline constexpr double needle_swing_step = 0.1;

/// Greatest distance, of a body's radius, from which contacts are looked for [-]: small bodies
/// would else see all of their neighbourhood.
inline constexpr double margin_of_radius = 0.1;
/// Least motion in a tick, of a body's or shape's radius, that its contacts foresee [-]: what has
/// no inside would else be watched at every motion. As far as contacts are looked for.
inline constexpr double foresight_of_radius = margin_of_radius;
/// Pairs of near shapes that any tick may have, and how many more for each shape. Balls of one size
/// have 6 each where they are packed, and things of mixed sizes some dozens; a pair takes about a
/// kilobyte with its contact, what the contact was before, and the rows of the
/// solver [-].
inline constexpr size_t pairs_at_least = 250'000, pairs_per_shape = 64;
/// Meridians and parallels on which planes touch round shapes that are parts of a body [-]: every
/// 22.5 degrees, so that planes of neighbours meet 2 % of the radius outside along a meridian.
inline constexpr int bare_meridians = 16, bare_parallels = 8;
/// One less the cosine of the angle of two planes that touch at one place [-].
inline constexpr double bare_same_way = 1e-12;
/// Width of a slit between two shapes of a body through which one comes in, of the body's size [-]:
/// that of shapes that share a face in numbers with six digits.
inline constexpr double inner_slit = 1e-5;
/// Corners of what is cut from a face are one where they are nearer than this, of a slit [-]: far
/// above the rounding of coordinates, far below the slit.
inline constexpr double slit_rounding = 1e-7;
/// Rounding of products of unit vectors, when the shortest vector of a hull is looked for [-].
inline constexpr double shortest_rounding = 1e-12;
/// A part of a body that widens by less than this over a length is as thick as it is there [-]:
/// its wall is within three degrees of even, and the ball in it does not move on.
inline constexpr double even_slope = 0.05;
/// How much of the growth that the walls promise a step of such a ball must bring [-] (Armijo), and
/// how short a step is tried, of the ball's radius [-]: the growth is known to their product.
inline constexpr double ball_step_gain = 0.25, least_ball_step = 1e-3;
/// Walls about a ball that are remembered, and steps that it may take [-]: a place has four walls,
/// and a ball that grows by an even step goes through a body of a hundred times its size.
inline constexpr size_t ball_walls = 8;
inline constexpr int most_ball_steps = 200;
/// Walls within this of its centre, in radii of the ball, are taken along when it moves [-]: of
/// more than it touches, so that it goes between two walls, not to and fro. Chosen by hand.
inline constexpr double wall_near_ball = 1.1;
/// A ball is larger than another where it is by this factor [-]: what is less is rounding.
inline constexpr double larger_ball = 1 + 1e-9;
/// A point whose distance from the edge of a ball is less than about half of this share of its
/// radius is not in it [-]: rounding again.
inline constexpr double same_ball = 1e-9;
/// Sets of shapes whose thickness is remembered [-]: more than the kinds of bodies that a scene
/// has; a number and a key each.
inline constexpr size_t remembered_thicknesses = 4096;
/// Turn in a tick up to which arcs are bounded by their series [rad]; beyond, by the diameter.
inline constexpr double series_turn = 1;

/// How many bodies ahead loops over bodies prefetch [-]: memory answers within the time of a few.
/// Chosen by hand.
inline constexpr size_t bodies_ahead = 8;

}  // namespace tumble::tolerances
