#pragma once

/// The constants of this folder that no option gives, with unit, reason, and source where there is
/// one.
namespace tumble::tolerances {

/// Distances at nodes are stored in 16 bits if that costs no more accuracy than this [diagonals of
/// the mesh], else in 32: the accuracy of an exact distance, and below the error between nodes.
inline constexpr double node_error = 1e-6;

/// Relative rounding of a double, with room for the few operations of a distance [-].
inline constexpr double distance_rounding = 1e-15;

/// A triangle is skipped only if its squared distance exceeds that of the nearest one found by more
/// than this share [-]: the normals of triangles that are barely not narrow (narrow_sine) are right
/// to 1e-13, and so are heights over planes of triangles of a thousand cells to 1e-10 cells.
inline constexpr double prune_slack = 1e-9;

/// Triangles whose area is less than this share of the square on their longest side, twice [-], are
/// narrow: the cross product of their sides has lost three digits, as where closest_on_triangle
/// computes by double-double numbers.
inline constexpr double narrow_sine = 1e-3;

/// A foot point is corrected until the field there is this small [cells]: less than the resolution
/// of 16 bits.
inline constexpr double foot_residual = 1e-5;

}  // namespace tumble::tolerances
