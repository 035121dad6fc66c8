#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Whether some group of a problem slides.
bool slides(const LcpProblem& problem);

/// Where there is no solution ever greater z are nearly one, measured by themselves: what is off
/// must be little beside b.
bool balances(const LcpProblem& problem, const LcpSolution& solution);

/// Sliding groups may be hard to solve, as A with the slopes in it is neither symmetric nor
/// definite. With so much added to b along the directions that no z changes where w_lateral points
/// the same groups, undecided, are easier, and from there it is a step to these.
Result<LcpSolution> solve_from_fast_slip(const LcpProblem& problem, bool few);

}  // namespace tumble::lcp
