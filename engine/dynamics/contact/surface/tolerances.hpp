#pragma once

/// The numbers of this folder: unit and reason. Lengths are divided by the size of the elements.
namespace tumble::tolerances {

/// Length, of the size, below which it has no direction of its own, or an ellipsoid is seen edge-on
/// [-]: half the digits of a double are left.
inline constexpr double no_direction = 1e-9;
/// Distance of two points below which they have no direction from one to the other [m]. Absolute:
/// points without radius have no size.
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
/// Divisor that is never zero [m]; finite after the division for radii up to 1e8 m.
inline constexpr double never_zero = 1e-300;

// Newton's method for nearest points and greatest separations.

/// Iterations until it is given up [-]: half a turn takes 7 of the longest steps, what is near a
/// solution converges quadratically, and the rest is for slow starts.
inline constexpr int newton_iterations = 60;
/// Longest step along a circle or on the sphere of normals [rad]: within it the second derivatives
/// of the start say something of the end.
inline constexpr double newton_longest_step = 0.5;
/// Step, of the size, that is rounding [-].
inline constexpr double newton_converged = 1e-13;
/// Step below which convergence is quadratic [rad]: one that does not fall to a half of the step
/// before is then rounding.
inline constexpr double newton_quadratic = 1e-7;
/// Curvature, of the size, that is added where the separation has no maximum by its second
/// derivatives [-] (Levenberg 1944).
inline constexpr double newton_damping = 1e-3;
/// Share of a step down to which it is halved until the separation grows [-]; ten times.
inline constexpr double newton_shortest_share = 1e-3;
/// Decrease of the separation, of the size, that is rounding [-].
inline constexpr double separation_rounding = 1e-15;

}  // namespace tumble::tolerances
