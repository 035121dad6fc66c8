#pragma once

/// The constants of this folder that no query gives, with unit and reason.
namespace tumble::tolerances {

/// Bounds are enlarged by this share of the greatest coordinate before the tree is searched [-]:
/// the rounding of the bounds.
inline constexpr double query_rounding = 1e-13;
/// Half the size of a box that contains everything, but whose extent is still finite [m].
inline constexpr double endless_half_size = 1e300;

}  // namespace tumble::tolerances
