#pragma once

/// The constants of this folder that no setup gives, with unit and reason.
namespace tumble::tolerances {

/// Share of the particles whose error may exceed the range of colours [-]: a few outliers would
/// darken all others.
inline constexpr double beyond_colours = 0.01;
/// Lower end of the plotted errors, relative to the sufficient error [-]: an error of 0 has no
/// logarithm.
inline constexpr double least_of_enough = 0.01;
/// Lower end of the plotted errors where the sufficient error is 0 [-].
inline constexpr double least_plotted_error = 1e-12;
/// Length of the longest force arrow, relative to the largest body [-].
inline constexpr double arrow_share = 0.9;
/// Step of a driven unknown that counts as none, relative to the largest force [-].
inline constexpr double no_pivot_step = 1e-9;
/// Relative accuracy of the depth that EPA is run to [-].
inline constexpr double epa_accuracy = 1e-9;
/// A step is shown if its time is at most this much later, in steps [-]: the clock's time is
/// rounded.
inline constexpr double due_step = 1e-9;
/// At most so many steps are advanced at once [-].
inline constexpr double most_due_steps = 1e6;

}  // namespace tumble::tolerances
