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

}  // namespace tumble::tolerances
