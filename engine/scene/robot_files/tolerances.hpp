#pragma once

namespace tumble::robot_tolerances {

/// Robot files give angles with three to eight digits (1.5708): directions within this angle count
/// as equal or perpendicular [rad], and lines within this distance as intersecting [m], for robots
/// of about a metre.
inline constexpr double same_direction = 1e-4, same_place = 1e-4;
/// A negative second moment of mass below this share of the largest is due to rounding in the file
/// [-].
inline constexpr double second_moment = 1e-6;
/// Share of the trace left to a second moment that is zero, so that the tensor can be inverted: as
/// for a rod a hundred times as long as thick, (1/100)^2 [-].
inline constexpr double thinnest = 1e-4;
inline constexpr double least_mass = 1e-12;  ///< [kg]: a smaller mass counts as none

}  // namespace tumble::robot_tolerances
