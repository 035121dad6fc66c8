#pragma once

/// The numbers of this room: unit and reason.
namespace tumble::tolerances {

/// What joints leave of a row's answer to its own push may be rounding, relative to that of free
/// bodies: the row is then as good as fixed [-].
inline constexpr double locked_share = 1e-11;
/// What one solution leaves of the rows' accelerations or velocities is rounding, relative to the
/// greatest that it was to change: a few hundred roundings [-].
inline constexpr double solved_share = 1e-13;
/// A row's velocity is held, relative to the velocities that cancel in it [-].
inline constexpr double held_share = 1e-14;
/// Length of a quaternion below which it names no rotation [-].
inline constexpr double no_rotation_length = 1e-12;

/// What reactions of joints with dependent rows leave of the pushes on bodies is rounding below
/// this, relative to the greatest push that a single row makes [-].
inline constexpr double reaction_rounding = 1e-14;
/// More than this, likewise, and bodies would move otherwise: the reactions stay what they were
/// [-].
inline constexpr double reaction_left = 1e-10;
/// The normal equations of such reactions have the square of the rows' condition: so many solves
/// bring what they leave to rounding [-].
inline constexpr int most_reaction_passes = 4;

/// How much greater the greatest moment of inertia of a body may be than the least for its joint to
/// be folded into it: the tensor's last digits are then small beside the least [-].
inline constexpr double most_moment_ratio = 1e6;
/// What is left of a pivot of a tensor of inertia is rounding, relative to what it was [-].
inline constexpr double no_pivot = 1e-14;
/// A row along a coordinate that others of its joint hold has as little left, likewise [-].
inline constexpr double no_drive = 1e-9;

/// Work of a joint of a folded tree, to factor and to solve [products].
inline constexpr unsigned folded_factor_price = 400, folded_solve_price = 100;

/// Sine of the angle between two axes below which no direction is across both of them: a thousand
/// million roundings [-].
inline constexpr double parallel_axes = 1e-7;
/// 1 + the cosine of such an angle, where the axes are opposite: the square of the same [-].
inline constexpr double opposite_axes = 1e-14;

}  // namespace tumble::tolerances
