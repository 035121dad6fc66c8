#pragma once

/// Constants of this folder, with unit and reason.
namespace tumble::tolerances {

/// Response of a row to its own push under the joints, relative to that of free bodies, below which
/// it is rounding error and the row counts as fixed [-].
inline constexpr double locked_share = 1e-11;
/// Remaining error of the rows' accelerations or velocities after one solution, relative to the
/// greatest wanted change, that is rounding error: a few hundred times that of a double [-].
inline constexpr double solved_share = 1e-13;
/// Error of a row's velocity, relative to the velocities that cancel in it, at which it counts as
/// held [-].
inline constexpr double held_share = 1e-14;
/// Length of a quaternion below which its rotation is undefined [-].
inline constexpr double no_rotation_length = 1e-12;

/// Error of the pushes on bodies by reactions of joints with dependent rows that is rounding error,
/// relative to the greatest push of a single row [-].
inline constexpr double reaction_rounding = 1e-14;
/// If the error is more than this, likewise, bodies would move differently, and the reactions stay
/// what they were [-].
inline constexpr double reaction_left = 1e-10;
/// The normal equations for such reactions have the square of the rows' condition number: this many
/// solutions reduce the error to rounding [-].
inline constexpr int most_reaction_passes = 4;
/// Rows of joints that are connected by loops, up to which `realtime` divides loads among them.
/// They are factored in every tick, which takes up to the cube of their number: half a millisecond
/// for so many. In larger loops each joint shows the load that its solver gave it [-].
inline constexpr size_t most_shared_rows = 128;

/// Greatest ratio of moments of inertia of a body at which its joint can be folded: rounding of the
/// tensor is then small compared with the least moment [-].
inline constexpr double most_moment_ratio = 1e6;
/// Remainder of a pivot of a tensor of inertia, relative to its original value, that is rounding
/// error [-].
inline constexpr double no_pivot = 1e-14;
/// The same for a row along a coordinate that other rows of its joint hold already [-].
inline constexpr double no_drive = 1e-9;

/// Work of a joint of a folded tree, to factor and to solve [multiply-adds].
inline constexpr unsigned folded_factor_price = 400, folded_solve_price = 100;

/// Sine of the angle between two axes below which no direction perpendicular to both is defined: a
/// thousand million times the rounding error [-].
inline constexpr double parallel_axes = 1e-7;
/// 1 + the cosine of the angle between axes that are opposite: the square of the same [-].
inline constexpr double opposite_axes = 1e-14;

}  // namespace tumble::tolerances
