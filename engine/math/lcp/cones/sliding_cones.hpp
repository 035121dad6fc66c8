#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Whether any group of a problem is sliding.
bool slides(const LcpProblem& problem);

/// Whether the residuals are small relative to b. Where no solution exists z may grow without
/// bound, so that residuals relative to its own terms become small and prove nothing.
bool balances(const LcpProblem& problem, const LcpSolution& solution);

/// Sliding groups may be hard to solve, since A with the slopes included is neither symmetric nor
/// definite. The same groups, undecided, are easier; with large values added to b, along the
/// lateral directions that no z influences, their w_lateral points in the prescribed directions,
/// and their solution is a good start for the sliding problem.
Result<LcpSolution> solve_from_fast_slip(const LcpProblem& problem, bool few);

}  // namespace tumble::lcp
