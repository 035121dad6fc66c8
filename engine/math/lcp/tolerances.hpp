#pragma once
#include <cstdint>

/// The numbers of the solvers that no option gives: unit, reason, and source where there is one.
/// All are without unit; "scaled" is said of unknowns in which diagonal entries of A are about 1
/// (scaling.hpp), and 1e-16 is the rounding of one operation.
namespace tumble::lcp::tolerances {

// -- problems and answers

/// Length of a direction differs from 1 by no more.
inline constexpr double direction_length = 1e-9;
/// (A_ij - A_ji)^2 of a symmetric A, relative to |A_ii A_jj|: 1e-10 squared.
inline constexpr double asymmetry2 = 1e-20;
/// An answer's violation is small beside the terms of the problem at rest too, not only beside the
/// answer's own, which may be huge.
inline constexpr double of_rest_terms = 1e-6;
/// Residual of a ray that proves that there is no solution.
inline constexpr double ray_proof = 1e-9;
/// Residual that rounding allows: methods that can go on stop there.
inline constexpr double best_residual = 1e-13;
/// Stands for 0 where something is divided by: of norms of a problem whose b is 0.
inline constexpr double never_zero_term = 1e-150;
/// Likewise of lengths and pivots of which no square is taken.
inline constexpr double never_zero = 1e-300;

// -- semi-smooth Newton (newton/)

/// Of best_residual: a start is not sought anew for less.
inline constexpr double good_enough = 100;
/// Of the merit, relative to the square of a term: the square of some ten roundings.
inline constexpr double merit_rounding = 1e-30;
inline constexpr int most_proximal_steps = 60;
/// Proximal steps that do not halve the residual.
inline constexpr int most_idle_steps = 3;
inline constexpr int most_newton_halvings = 12;
/// Share of the predicted descent that is asked for (Armijo).
inline constexpr double newton_descent = 1e-3;
/// Share of the merit by which it must fall, or Newton's method has stalled.
inline constexpr double least_descent = 1e-6;
/// Of a stalled merit, relative to rounding: proximal steps may still bring it down.
inline constexpr double stalled_merit = 1e6;
/// Change of an unknown by a sweep of projected Gauss-Seidel that has diverged.
inline constexpr double diverged_sweep = 1e100;
/// Weight of a proximal step, scaled: far above rounding, far below the diagonal.
inline constexpr double usual_weight = 1e-7;
/// Weights after sweeps where the usual one did not do: two that move less, one that hardly acts.
inline constexpr double other_weights[] = {1e-4, 1e-2, 1e-10};
/// Pivot of a row that depends on those before it, scaled.
inline constexpr double lost_row = 1e-9;
/// Residual from which on refining with one factorisation is not worth a try.
inline constexpr double refinable_residual = 1e-3;
/// Each further pass of it must leave no more of the residual.
inline constexpr double refined_share = 0.1;
inline constexpr int most_refinements = 4;

// -- path of smoothed problems (interior/)

inline constexpr int most_path_systems = 300;
/// Newton steps for one smoothing.
inline constexpr int most_path_steps = 12;
/// |F|, relative to the smoothing, where the path counts as reached.
inline constexpr double near_path = 0.5;
/// Factors of the smoothing from step to step.
inline constexpr double fastest_path = 0.05, slowest_path = 0.97;
/// Smoothing at which the path is sought, relative to the greatest |b|.
inline constexpr double farthest_path = 1e6;
/// Smoothing at the end of the path, likewise: the rounding of b.
inline constexpr double path_end = 1e-16;
/// Smoothing, likewise, from which on a path that turns back is left at its best point.
inline constexpr double nearly_path_end = 1e-12;
/// Share of the predicted descent that is asked for on the path (Armijo).
inline constexpr double path_descent = 1e-4;
/// Weight of a proximal step on the path, scaled: with a matrix, and with blocks.
inline constexpr double dense_path_weight = 1e-8, block_path_weight = 1e-7;
/// Lateral length, relative to the smoothing, below which the limit of the slope at the axis is
/// taken: the quotient loses its digits.
inline constexpr double smoothed_axis = 1e-8;
/// Slope of a cone that lets nothing lateral through.
inline constexpr double flat_cone = 1e-9;

// -- forms of A (system/, blocks/, sweep/)

/// Diagonal entry that nothing is divided by, scaled.
inline constexpr double no_stiffness = 1e-12;
/// Pivot relative to the greatest entry with which a step would be noise.
inline constexpr double lost_pivot = 1e-22;
/// Pivot of a block, relative to its greatest entry, that is rounding.
inline constexpr double block_rank_lost = 1e-15;
/// Weight in least squares with blocks: 1 + G^T G / weight costs seven digits, which further passes
/// bring back.
inline constexpr double least_squares_weight = 1e-7;
inline constexpr int most_least_squares_passes = 12;
/// Square of a change relative to that of the solution: nothing moves any more.
inline constexpr double least_squares_still = 1e-30;
/// Greatest change by a sweep, relative to the greatest unknown: nothing moves any more.
inline constexpr double sweep_still = 1e-16;

// -- pivoting (pivoting/)

// Of rates, in scaled units, the driven unknown's being 1.
inline constexpr double still = 1e-14;           ///< an unknown does not move
inline constexpr double steady = 1e-13;          ///< a w does not change
inline constexpr double steady_resting = 1e-11;  ///< the same where rows depend on each other
inline constexpr double no_remainder = 1e-9;     ///< a Schur complement that may be 0
inline constexpr double indefinite = -1e-6;      ///< one that no rounding makes of 0
inline constexpr double rounded_change = 1e-4;   ///< A d, of d, that rounding of A may leave
inline constexpr double rounded_w = 1e-10;  ///< w, of its terms, that rounding of rows may leave
inline constexpr double least_remainder = 1e-15;  ///< with which an unknown is clamped
inline constexpr int most_driver_rounds = 5;
/// What w has of rounding, relative to the terms that make it up.
inline constexpr double w_rounding = 1e-13;
/// Pivot, scaled, of an unknown that is left to be driven, with more care.
inline constexpr double least_start_pivot = 1e-9;
/// Added to the diagonal, scaled, where small pivots are of the size of rounding (Rockafellar
/// 1976).
inline constexpr double dantzig_weight = 2e-9;
/// Pivot of the clamped rows of cones, relative to the greatest entry, that is rounding.
inline constexpr double lost_clamped_pivot = 1e-12;
/// Entry of Lemke's table, scaled, that is no pivot.
inline constexpr double lemke_no_pivot = 1e-11;
/// Quotients of right sides, and of columns of w, that are equal but for rounding.
inline constexpr double lemke_same_side = 1e-13, lemke_same_column = 1e-12;
/// 3^12: what may be enumerated.
inline constexpr double most_assignments = 531441;
/// Pivot of an enumerated set, relative to the greatest entry, that is rounding.
inline constexpr double lost_enumerated_pivot = 1e-11;

// -- sequence of solvers (cones/)

/// Residual that is sought where Newton's method is at home.
inline constexpr double sharp_residual = 1e-12;
/// Systems of blocks after which Newton's method has stalled; and where the path does not answer.
inline constexpr int first_block_systems = 60, patient_block_systems = 400;
/// Factors of a symmetric matrix that the path takes at least: ten systems that are not symmetric.
inline constexpr uint64_t factors_of_path = 20;
/// What an answer may be out of balance, of the greatest |b|, in units of the diagonal of A.
inline constexpr double off_balance = 1e-8;
/// Slip at which undecided groups are as good as sliding ones, of the greatest |b|.
inline constexpr double fast_slip = 1e4;

// -- least solutions (least/)

/// What w has of rounding at least, relative to the terms of A z + b.
inline constexpr double least_w_rounding = 1e-10;
/// Gradient, relative to the solution, that ends the search; and that an ended search may have.
inline constexpr double least_gradient = 1e-14, found_gradient = 1e-12;
/// Share of the predicted descent that is asked for (Armijo), but for the rounding of a value.
inline constexpr double dual_descent = 1e-4, dual_value_rounding = 1e-15;
/// Added to the diagonal of the dual's second derivatives: a share of the gradient relative to the
/// solution, no more than the second number, and always the third.
inline constexpr double dual_weight = 1e-3, most_dual_weight = 1e-2, least_dual_weight = 1e-14;
/// Pivot of these, relative to the greatest entry, that is rounding.
inline constexpr double lost_dual_pivot = 1e-18;
/// Squares of columns of which the first is as good as the greatest, relative.
inline constexpr double same_column = 1e-9;
/// Rest of a column, of length about 1, that lies in the span of those before it.
inline constexpr double in_span = 1e-10;
/// A lateral unknown is within its pyramid but for rounding, relative.
inline constexpr double pyramid_rounding = 1e-14;

}  // namespace tumble::lcp::tolerances
