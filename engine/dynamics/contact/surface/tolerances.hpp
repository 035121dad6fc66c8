#pragma once

/// Constants of this folder with unit and reason. A share "of the size" is relative to the size of
/// the elements.
namespace tumble::tolerances {

/// Length, of the size, below which a vector has no reliable direction, or an ellipsoid is seen
/// edge-on [-]: half the digits of a double are left.
inline constexpr double no_direction = 1e-9;
/// Distance of two points below which the direction from one to the other is undefined [m].
/// Absolute, since points without radius have no size.
inline constexpr double coincident_points = 1e-12;
/// Angle of two lines, or tangents, below which they count as parallel [rad]: their common normal
/// is right to the tenth digit above it, its second derivative (the square) to the fourth.
inline constexpr double parallel_lines = 1e-6;
/// Sine of the angle of two edges below which their normal cannot be differentiated [-]: the
/// formulas of normal_rate divide once by it.
inline constexpr double parallel_edges = 1e-9;
/// Determinant over the square of the trace, or curvature times size, below which a system of two
/// equations is singular [-]: ten thousand roundings.
inline constexpr double singular = 1e-12;
/// Lower bound of a divisor [m], so that it is never zero; quotients are finite for radii up to 1e8
/// m.
inline constexpr double never_zero = 1e-300;

// Newton's method for nearest points and greatest separations.

/// Most iterations [-]: half a turn takes 7 of the longest steps, convergence near the solution is
/// quadratic, and the rest is for slow starts.
inline constexpr int newton_iterations = 60;
/// Longest step along a circle or on the sphere of normals [rad]: the quadratic model at the start
/// is still useful within it.
inline constexpr double newton_longest_step = 0.5;
/// Step, of the size, that is rounding error: the iteration has converged [-].
inline constexpr double newton_converged = 1e-13;
/// Step below which convergence is quadratic [rad]: a step that is then more than half of the one
/// before is rounding error.
inline constexpr double newton_quadratic = 1e-7;
/// Curvature, of the size, that is added where the Hessian of the separation is not negative
/// definite [-] (Levenberg 1944).
inline constexpr double newton_damping = 1e-3;
/// A step is halved until the separation grows, down to this share of it [-]: ten times.
inline constexpr double newton_shortest_share = 1e-3;
/// Decrease of the separation, of the size, that is rounding error [-].
inline constexpr double separation_rounding = 1e-15;

}  // namespace tumble::tolerances
