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
/// Rays in even steps by which the ball inside a body of several shapes is found [-]: what lies
/// between two is off by a sixth of a radian at most, which makes a ball too large by 2 %.
inline constexpr int inner_rays = 200;
/// In which order they are cast: every 77th, which has no factor in common with their number [-].
inline constexpr size_t inner_ray_stride = 77;
/// Width of a slit between two shapes through which such a ray passes, of the body's size [-]: that
/// of shapes that share a face in numbers with six digits.
inline constexpr double inner_slit = 1e-5;
/// Turn in a tick up to which arcs are bounded by their series [rad]; beyond, by the diameter.
inline constexpr double series_turn = 1;

/// How many bodies ahead loops over bodies prefetch [-]: memory answers within the time of a few.
/// Chosen by hand.
inline constexpr size_t bodies_ahead = 8;

}  // namespace tumble::tolerances
