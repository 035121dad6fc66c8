#pragma once

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Distances of candidates are rounded to single precision relative to their cell: so much more of
/// the reach is taken [-]. A hundred times what 24 bits round in a cube of three cells.
inline constexpr double neighbour_rounding = 1e-5;
/// Points so many cells from the origin are refused [-]: beyond 2^53 neighbouring cells would have
/// no numbers of their own.
inline constexpr double most_cells = 9.0e15;
/// Coordinate of what is near nothing, relative to a cell [m]: its square is finite in single
/// precision.
inline constexpr float far_coordinate = 1e18f;
/// How far from all points the place is that fills lists [reaches].
inline constexpr double far_reaches = 1e3;

/// A scene gives no longer lengths of what emits [m]: those of its shapes.
inline constexpr double longest_emission = 1e6;
/// Likewise of sinks [m], which may be all around a world: its farthest places.
inline constexpr double longest_sink = 1e7;

/// A mesh must fill this share of its box for points inside it to be found by trying [-]: then a
/// thousand tries give one in the mean, of some ten microseconds each.
inline constexpr double least_filling = 1e-3;

/// What is drawn from a normal distribution is within so many standard deviations [-]: one draw in
/// sixteen thousand is farther and is repeated, so that what may be drawn has bounds.
inline constexpr double normal_reach = 4;

/// A product of a rate and a time, both rounded, that is this near to a whole number is that [-]:
/// four times the rounding of a product of two rounded numbers.
inline constexpr double count_rounding = 0x1p-50;

/// More births than an emitter can have [-]; exactly a number, and far below what overflows a
/// count.
inline constexpr double most_births = 1e18;

}  // namespace tumble::tolerances
