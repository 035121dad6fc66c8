#pragma once
#include <cstdint>

/// The constants of the solvers that no option gives, with reason, and source where there is one.
/// All are dimensionless; "scaled" refers to units in which diagonal entries of A are about 1
/// (scaling.hpp), and 1e-16 is the rounding error of one operation.
namespace tumble::lcp::tolerances {

// -- problems and results

/// Tolerance of the length 1 of a direction.
inline constexpr double direction_length = 1e-9;
/// Largest (A_ij - A_ji)^2 of a symmetric A, relative to |A_ii A_jj|: 1e-10 squared.
inline constexpr double asymmetry2 = 1e-20;
/// A residual must also be small relative to the terms of the problem at z nearest to 0, and not
/// only to those of the solution, which may be huge.
inline constexpr double of_rest_terms = 1e-6;
/// Residual of a ray that proves infeasibility.
inline constexpr double ray_proof = 1e-9;
/// Residual of the size of rounding, at which methods that could go on stop.
inline constexpr double best_residual = 1e-13;
/// Divisor instead of 0, for lengths and pivots.
inline constexpr double never_zero = 1e-300;

// -- semi-smooth Newton (newton/)

/// In units of best_residual: no new start is tried below this.
inline constexpr double good_enough = 100;
/// Limit of steps in a row that do not halve the merit function.
inline constexpr int most_idle_steps = 6;
inline constexpr int most_newton_halvings = 12;
/// Share of the predicted decrease that is required (Armijo).
inline constexpr double newton_descent = 1e-3;
/// Change of an unknown in a sweep of projected Gauss-Seidel that has diverged.
inline constexpr double diverged_sweep = 1e100;
/// Weight of a proximal term, which stands on the diagonal of Newton's linear systems, scaled: far
/// above rounding, far below the rest of the diagonal.
inline constexpr double usual_weight = 1e-7;
/// Weights tried after sweeps if the usual one fails: two that allow smaller steps, and one with
/// hardly any effect.
inline constexpr double other_weights[] = {1e-4, 1e-2, 1e-10};
/// Pivot of a row that depends on previous rows, scaled.
inline constexpr double lost_row = 1e-9;
/// Above this residual, refinement with one factorisation is not tried.
inline constexpr double refinable_residual = 1e-3;
/// Each refinement must reduce the residual to this share.
inline constexpr double refined_share = 0.1;
inline constexpr int most_refinements = 4;

// -- path of smoothed problems (interior/)

inline constexpr int most_path_systems = 300;
/// Newton steps for one smoothing.
inline constexpr int most_path_steps = 12;
/// |F|, relative to the smoothing, at which the path counts as reached.
inline constexpr double near_path = 0.5;
/// Factors of the smoothing from step to step.
inline constexpr double fastest_path = 0.05, slowest_path = 0.97;
/// Largest smoothing at which the path is searched for, relative to the greatest |b|.
inline constexpr double farthest_path = 1e6;
/// Smoothing at the end of the path, relative to the greatest |b|: the rounding of b.
inline constexpr double path_end = 1e-16;
/// Smoothing, relative to the greatest |b|, below which a path that turns back is left at its best
/// point.
inline constexpr double nearly_path_end = 1e-12;
/// Share of the predicted decrease that is required on the path (Armijo).
inline constexpr double path_descent = 1e-4;
/// Weight of a proximal term on the path, scaled: with a dense matrix, and with blocks.
inline constexpr double dense_path_weight = 1e-8, block_path_weight = 1e-7;
/// Lateral length, relative to the smoothing, below which the limit of the derivative at the axis
/// is used, as the quotient loses its digits.
inline constexpr double smoothed_axis = 1e-8;
/// Slope below which a cone has no lateral extent.
inline constexpr double flat_cone = 1e-9;

// -- forms of A (system/, blocks/, sweep/)

/// Diagonal entry that is not divided by, scaled.
inline constexpr double no_stiffness = 1e-12;
/// Pivot, relative to the greatest entry, below which a step would be noise.
inline constexpr double lost_pivot = 1e-22;
/// Pivot of a block, relative to its greatest entry, that is rounding error.
inline constexpr double block_rank_lost = 1e-15;
/// Weight in least squares with blocks: 1 + G^T G / weight costs seven digits, which further passes
/// recover.
inline constexpr double least_squares_weight = 1e-7;
inline constexpr int most_least_squares_passes = 12;
/// Convergence: square of a change relative to that of the solution.
inline constexpr double least_squares_still = 1e-30;
/// Convergence: greatest change in a sweep, relative to the greatest unknown.
inline constexpr double sweep_still = 1e-16;

// -- pivoting (pivoting/)

// Rates, in scaled units, relative to that of the driven unknown.
inline constexpr double still = 1e-14;           ///< an unknown does not move
inline constexpr double steady = 1e-13;          ///< a w does not change
inline constexpr double steady_resting = 1e-11;  ///< the same where rows depend on each other
inline constexpr double no_remainder = 1e-9;     ///< a Schur complement that may be 0
/// A Schur complement that is negative beyond rounding.
inline constexpr double indefinite = -1e-6;
/// |A d| relative to |d| that rounding of A may leave.
inline constexpr double rounded_change = 1e-4;
/// W relative to its terms that rounding of rows may leave.
inline constexpr double rounded_w = 1e-10;
/// Least Schur complement with which an unknown is clamped.
inline constexpr double least_remainder = 1e-15;
inline constexpr int most_driver_rounds = 5;
/// Rounding error of w, relative to the terms that add up to it.
inline constexpr double w_rounding = 1e-13;
/// Least pivot, scaled, in the block start; other unknowns are driven, which is more careful.
inline constexpr double least_start_pivot = 1e-9;
/// Added to the diagonal, scaled, if small pivots are of the size of rounding (Rockafellar 1976).
inline constexpr double dantzig_weight = 2e-9;
/// Pivot of the clamped rows of cones, relative to the greatest entry, that is rounding error.
inline constexpr double lost_clamped_pivot = 1e-12;
/// Entry of Lemke's tableau, scaled, that is too small for a pivot.
inline constexpr double lemke_no_pivot = 1e-11;
/// Quotients of right-hand sides, and of columns of w, that count as equal.
inline constexpr double lemke_same_side = 1e-13, lemke_same_column = 1e-12;
/// 3^12: limit of enumeration.
inline constexpr double most_assignments = 531441;
/// Pivot of an enumerated set, relative to the greatest entry, that is rounding error.
inline constexpr double lost_enumerated_pivot = 1e-11;

// -- sequence of solvers (cones/)

/// Residual aimed at by Newton's method where it converges well.
inline constexpr double sharp_residual = 1e-12;
/// Limits of block systems: for the first attempt of Newton's method; and for one after the path
/// has failed.
inline constexpr int first_block_systems = 60, patient_block_systems = 400;
/// Minimal cost of the path in factorisations of a symmetric matrix: ten unsymmetric systems.
inline constexpr uint64_t factors_of_path = 20;
/// Allowed imbalance of a result, relative to the greatest |b|, in units of the diagonal of A.
inline constexpr double off_balance = 1e-8;
/// Slip at which undecided groups are nearly sliding ones, relative to the greatest |b|.
inline constexpr double fast_slip = 1e4;

// -- least solutions (least/)

/// Least rounding error of w, relative to the terms of A z + b.
inline constexpr double least_w_rounding = 1e-10;
/// Gradient, relative to the solution, that ends the search; and largest one of an accepted result.
inline constexpr double least_gradient = 1e-14, found_gradient = 1e-12;
/// Share of the predicted decrease that is required (Armijo), and rounding of the dual function.
inline constexpr double dual_descent = 1e-4, dual_value_rounding = 1e-15;
/// Added to the diagonal of the dual's Hessian: the first times the gradient relative to the
/// solution, at most the second, at least the third.
inline constexpr double dual_weight = 1e-3, most_dual_weight = 1e-2, least_dual_weight = 1e-14;
/// Pivot of that Hessian, relative to the greatest entry, that is rounding error.
inline constexpr double lost_dual_pivot = 1e-18;
/// Relative difference of squared column lengths within which the first column is chosen.
inline constexpr double same_column = 1e-9;
/// Remainder of a column, of length about 1, that lies in the span of the previous ones.
inline constexpr double in_span = 1e-10;
/// Relative rounding within which a lateral unknown counts as inside its pyramid.
inline constexpr double pyramid_rounding = 1e-14;

}  // namespace tumble::lcp::tolerances
