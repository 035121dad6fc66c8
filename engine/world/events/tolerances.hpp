#pragma once
#include <cstddef>

namespace tumble::tolerances {

/// Relative normal speed below which contact is not an impact, in ticks of free fall [-]
/// (Frame::usual_gravity): bodies that rest or rattle reach about one.
inline constexpr double strike_ticks = 2;
/// The same where there is no gravity [m/s].
inline constexpr double least_strike = 0.01;
/// If a tick has more events of a kind than this, they are listed as one entry [-]: the list is for
/// people.
inline constexpr size_t most_told_singly = 8;
/// Only so many impacts of a tick are kept, the strongest ones [-].
inline constexpr size_t most_impacts = 32;

}  // namespace tumble::tolerances
