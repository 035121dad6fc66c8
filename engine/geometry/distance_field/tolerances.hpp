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
/// than this share [-]: the normals of triangles that are barely not needles (node_error) are right
/// to 1e-10.
inline constexpr double prune_slack = 1e-9;

/// A foot point is corrected until the field there is this small [cells]: less than the resolution
/// of 16 bits.
inline constexpr double foot_residual = 1e-5;

}  // namespace tumble::tolerances
