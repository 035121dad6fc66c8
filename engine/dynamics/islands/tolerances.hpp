#pragma once

/// The numbers of this room: unit and reason.
namespace tumble::tolerances {

/// Distance at which a sleeper and what comes near count as touching, of the margin within which
/// contacts are foreseen [-]: what merely passes by wakes nobody.
inline constexpr double touching_of_margin = 0.05;
/// That margin [m], the default of RealtimeSettings::speculative_margin: who wakes does not depend
/// on how the solver is tuned.
inline constexpr double touching_margin = 0.02;

}  // namespace tumble::tolerances
