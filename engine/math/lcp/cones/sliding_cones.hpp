#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Whether some group of a problem slides.
bool slides(const LcpProblem& problem);

/// Whether the residuals are small relative to b. Where no solution exists z may grow without
/// bound, so that residuals relative to its own terms become small and prove nothing.
bool balances(const LcpProblem& problem, const LcpSolution& solution);

/// Sliding groups may be hard to solve, as A with the slopes in it is neither symmetric nor
/// definite. With so much added to b along the directions that no z changes where w_lateral points
/// the same groups, undecided, are easier, and from there it is a step to these.
Result<LcpSolution> solve_from_fast_slip(const LcpProblem& problem, bool few);

}  // namespace tumble::lcp
