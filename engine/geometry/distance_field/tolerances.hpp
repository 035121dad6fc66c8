#pragma once

/// The numbers of this folder that no option gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Distances at nodes are kept in 16 bits where that costs no more than this [diagonals of the
/// mesh], else in 32: what one expects of an exact distance, and beneath any error between nodes.
inline constexpr double node_error = 1e-6;

/// Relative rounding of a double, with room for the few operations of a distance [-].
inline constexpr double distance_rounding = 1e-15;

/// A triangle is passed over only where it is farther than what has been found by this part of its
/// square [-]: normals of triangles that are just no needles (node_error) are right to 1e-10.
inline constexpr double prune_slack = 1e-9;

/// A point is put back onto the surface until the field there is this small [cells]: less than
/// 16 bits tell apart.
inline constexpr double foot_residual = 1e-5;

}  // namespace tumble::tolerances
