#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Of all solutions with the w of a given one (for a semi-definite A without undecided groups: of
/// all solutions), that with the least sum of squares of z. It is unique, so it has every symmetry
/// that the problem has. Bounds, cones and complementarity are kept.
///
/// The nearest point to 0 in the intersection of {A z = A z0} with a product of intervals and cones
/// is P(Q y), Q a basis of the rows of A and y the zero of Q^T (P(Q y) - z0): semi-smooth Newton on
/// that convex dual (Qi & Sun 2006). `iterations` are added to those of the solution. If the result
/// cannot be had within the tolerance, or `solution` is not solved, it comes back unchanged except
/// that a solved status becomes max_iterations. Errors: those of check(); z of another size.
Result<LcpSolution> minimum_norm(const LcpProblem& problem, const LcpSolution& solution,
                                 const LcpOptions& options = {});

}  // namespace tumble::lcp
