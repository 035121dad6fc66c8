#pragma once
#include <cstddef>

/// Constants of this folder that are no settings: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Relative increase of the reach, since distances of candidates are rounded to single precision
/// relative to their cell [-]: a hundred times the rounding error of 24 bits in a cube of three
/// cells.
inline constexpr double neighbour_rounding = 1e-5;
/// Points this many cells from the origin are refused [-]: beyond 2^53 neighbouring cells could not
/// be told apart.
inline constexpr double most_cells = 9.0e15;
/// Pairs of points that a radial distribution looks at [-]: less than a second on one core. Ten
/// times fewer already give each of a hundred shells to a percent.
inline constexpr double most_radial_pairs = 2e7;
/// What it takes to find the points of a cell in a sorted list, in pairs that are looked at [-].
inline constexpr double radial_lookup = 20;
/// Points from which the work of a radial distribution is estimated [-]: a cluster with so small a
/// share of all points that none of these is in it has no more than a millionth of all pairs.
inline constexpr size_t radial_samples = 1024;
/// Coordinate of padding that is near nothing, relative to a cell [m]: its square is finite in
/// single precision.
inline constexpr float far_coordinate = 1e18f;
/// Distance of the place that pads lists from all points [reaches].
inline constexpr double far_reaches = 1e3;

/// Greatest length of an emission shape in a scene [m]: that of shapes of bodies.
inline constexpr double longest_emission = 1e6;
/// The same for sinks [m], which may surround a world: its farthest positions.
inline constexpr double longest_sink = 1e7;

/// Least share of its bounding box that a mesh must fill for points inside it to be found by
/// rejection [-]: a thousand tries on average, of some ten microseconds each.
inline constexpr double least_filling = 1e-3;

/// Truncation of normal distributions, in standard deviations [-]: one draw in sixteen thousand is
/// outside and is repeated, so that values are bounded.
inline constexpr double normal_reach = 4;

/// Relative difference from a whole number within which a product of a rate and a time counts as
/// one [-]: four times the rounding error of a product of two rounded numbers.
inline constexpr double count_rounding = 0x1p-50;

/// Greatest number of births of an emitter [-]: exact in double precision, and far below the
/// overflow of a counter.
inline constexpr double most_births = 1e18;

}  // namespace tumble::tolerances
