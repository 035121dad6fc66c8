#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The method for A = G G^T: block_newton, which is fast where it converges and can begin at a
/// start; where it stalls block_interior, which does not; then block_newton for as long as it will.
/// The report names who answered: `cone_newton` or `cone_interior`. Residuals of 1e-12 are sought,
/// `solved` is what is within options.tolerance. Of several that fail the best comes back.
/// `start` may be null. Errors: those of check(), and a start that does not fit.
Result<LcpSolution> solve_blocks(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start);

}  // namespace tumble::lcp
