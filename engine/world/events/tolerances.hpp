#pragma once
#include <cstddef>

namespace tumble::tolerances {

/// Bodies that approach or part more slowly than in so many ticks of free fall do not strike each
/// other [-]: what rests or rattles reaches one.
inline constexpr double strike_ticks = 2;
/// Where there is no gravity: slower is no impact [m/s].
inline constexpr double least_strike = 0.01;
/// Of a kind in a tick, more are told of together [-]: the list is for people.
inline constexpr size_t most_told_singly = 8;
/// Of the impacts of a tick the strongest so many are kept [-].
inline constexpr size_t most_impacts = 32;

}  // namespace tumble::tolerances
