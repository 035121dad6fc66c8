#pragma once

/// The numbers of this room that no setup gives: unit and reason.
namespace tumble::tolerances {

/// Of the particles, those whose error is beyond the colours [-]: a few would darken all others.
inline constexpr double beyond_colours = 0.01;
/// Of the error that is enough, what the plot shows at least [-]: an error of 0 has no logarithm.
inline constexpr double least_of_enough = 0.01;
/// And at least this, where the error that is enough is 0 [-].
inline constexpr double least_plotted_error = 1e-12;
/// Length of the longest arrow of a force, of the largest body [-].
inline constexpr double arrow_share = 0.9;
/// Step of a driven unknown that is none, of the largest force [-].
inline constexpr double no_pivot_step = 1e-9;
/// Depth of EPA, relative, that is looked for [-].
inline constexpr double epa_accuracy = 1e-9;
/// A step is due that is so near, in steps [-]: the clock's time has rounding.
inline constexpr double due_step = 1e-9;
/// More steps than this are never gone forward at once [-].
inline constexpr double most_due_steps = 1e6;

}  // namespace tumble::tolerances
