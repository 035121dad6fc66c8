#pragma once

/// The numbers of this room that no query gives: unit and reason.
namespace tumble::tolerances {

/// What bounds grow by before the tree is asked, relative to the greatest coordinate [-]: the
/// rounding of the bounds.
inline constexpr double query_rounding = 1e-13;
/// Half the size of a box that holds everything, whose extent is still finite [m].
inline constexpr double endless_half_size = 1e300;

}  // namespace tumble::tolerances
