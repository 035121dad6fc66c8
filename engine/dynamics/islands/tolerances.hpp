#pragma once

/// Constants of this folder, with unit and reason.
namespace tumble::tolerances {

/// Gap up to which a sleeping body and one that approaches count as touching, as a share of the
/// margin within which contacts are foreseen [-]: a body that only passes by wakes nothing.
inline constexpr double touching_of_margin = 0.05;
/// That margin [m]: the default of RealtimeSettings::speculative_margin. A constant, so that waking
/// does not depend on settings of the solver.
inline constexpr double touching_margin = 0.02;

}  // namespace tumble::tolerances
