#pragma once

namespace tumble::robot_tolerances {

/// Robot files give three to eight digits of angles (1.5708): directions this near are one, at
/// right angles, or cross each other [rad], and [m] of a robot of the size of a metre.
inline constexpr double same_direction = 1e-4, same_place = 1e-4;
/// A second moment of mass below zero by this share of the largest is rounding of the file [-].
inline constexpr double second_moment = 1e-6;
/// What is left of a second moment that is none, so that the tensor can be inverted: as of a rod a
/// hundred times as long as it is thick, (1/100)^2 and a bit [-].
inline constexpr double thinnest = 1e-4;
inline constexpr double least_mass = 1e-12;  ///< [kg]: less is none

}  // namespace tumble::robot_tolerances
