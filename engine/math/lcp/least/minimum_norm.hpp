#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Of all solutions with the same w as the given one (for a semi-definite A without undecided
/// groups: of all solutions), the one of least norm |z|. It is unique, so it has every symmetry of
/// the problem. Bounds, cones and complementarity are kept.
///
/// The point nearest to 0 in the intersection of {A z = A z0} with a product of intervals and cones
/// is P(Q y), with Q a basis of the rows of A and y the zero of Q^T (P(Q y) - z0): semi-smooth
/// Newton on that convex dual (Qi & Sun 2006). `iterations` are added to those of the solution. If
/// the result does not meet the tolerance, or `solution` is not solved, it is returned unchanged,
/// except that a solved status becomes max_iterations. Errors: those of check(); z of another size.
Result<LcpSolution> minimum_norm(const LcpProblem& problem, const LcpSolution& solution,
                                 const LcpOptions& options = {});

}  // namespace tumble::lcp
