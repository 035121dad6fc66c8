#pragma once
#include <cstddef>

/// Constants of this folder that are no settings: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Greatest difference from 1 of the length of a quaternion in a definition [-]: three written
/// digits.
inline constexpr double quaternion_length = 1e-3;
/// Relative rounding error of principal moments [-]: for a flat body the greatest equals the sum of
/// the other two.
inline constexpr double principal_moments = 1e-9;
/// Rounding error of the entries of an inertia tensor, relative to the greatest [-]: within it a
/// tensor counts as symmetric, or isotropic. Ten thousand times that of a double, as in sums over
/// triangles.
inline constexpr double inertia_entries = 1e-12;

/// Ratio of the greatest to the least principal moment from which on a body is a needle [-].
/// Implicit rules for its rotation need sub-steps of the inverse of this ratio [rad], which is
/// affordable up to here.
inline constexpr double needle_moment_ratio = 20;
/// Rotation of a needle about its length in one step of its rule [rad]: the error of the energy is
/// then a thousandth (second order).
inline constexpr double needle_swing_step = 0.1;

/// Greatest distance at which contacts are foreseen without motion, as a share of a body's radius
/// [-]: small bodies would otherwise see much of their surroundings.
inline constexpr double margin_of_radius = 0.1;
/// Least motion in a tick, as a share of a body's or shape's radius, that foreseen contacts cover
/// [-]: bodies without an inside would otherwise be swept at every motion. The same as
/// margin_of_radius.
inline constexpr double foresight_of_radius = margin_of_radius;
/// Number of pairs that any tick may have, and additional pairs per shape [-]. Packed balls of
/// equal size have 6 each, and mixed sizes some dozens; a pair takes about a kilobyte, with its
/// contact, that of the tick before, and the solver's rows.
inline constexpr size_t pairs_at_least = 250'000, pairs_per_shape = 64;
/// Numbers of meridians and parallels at which tangent planes represent round shapes of a body [-]:
/// every 22.5 degrees, so that neighbouring planes meet 2 % of the radius outside along a meridian.
inline constexpr int bare_meridians = 16, bare_parallels = 8;
/// 1 - cosine of the angle between two planes below which they are parallel, at one place [-].
inline constexpr double bare_same_way = 1e-12;
/// Width of a slit between two shapes of a body up to which it counts as closed, as a share of the
/// body's size [-]: the gap between shapes that share a face, in numbers of six digits.
inline constexpr double inner_slit = 1e-5;
/// Distance below which corners of a cut face coincide, as a share of a slit [-]: far above the
/// rounding of coordinates, far below the slit.
inline constexpr double slit_rounding = 1e-7;
/// Rounding error of products of unit vectors in the search for the shortest vector of a hull [-].
inline constexpr double shortest_rounding = 1e-12;
/// Slope up to which a part of a body that widens along its length counts as even [-]: its wall is
/// within three degrees of parallel, and the ball in it does not move on.
inline constexpr double even_slope = 0.05;
/// Share of the predicted growth that a step of such a ball must give [-] (Armijo), and the
/// shortest step that is tried, as a share of the ball's radius [-]: growth is known to the
/// accuracy of their product.
inline constexpr double ball_step_gain = 0.25, least_ball_step = 1e-3;
/// Number of walls that are remembered for a ball, and most steps that it may take [-]: an
/// equilibrium has four walls, and a ball that grows steadily passes through a body of a hundred
/// times its size.
inline constexpr size_t ball_walls = 8;
inline constexpr int most_ball_steps = 200;
/// Walls within this distance from its centre, in radii of the ball, affect its direction [-]: more
/// than those it touches, so that it moves between two walls without zigzagging. Chosen by hand.
inline constexpr double wall_near_ball = 1.1;
/// Factor by which a ball must be larger than another to count as larger [-]: less is rounding
/// error.
inline constexpr double larger_ball = 1 + 1e-9;
/// A point that is inside a ball by less than about half of this share of its radius counts as
/// outside [-]: rounding error.
inline constexpr double same_ball = 1e-9;
/// Number of sets of shapes whose thickness is cached [-]: more than the kinds of bodies in a
/// scene; each takes a number and a key.
inline constexpr size_t remembered_thicknesses = 4096;
/// Rotation in a tick up to which the height of arcs is bounded by a series [rad]; beyond, by the
/// diameter.
inline constexpr double series_turn = 1;

/// How many bodies ahead loops over bodies prefetch [-]: the latency of memory is that of a few
/// bodies. Chosen by hand.
inline constexpr size_t bodies_ahead = 8;

}  // namespace tumble::tolerances
