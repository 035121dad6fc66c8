#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

class BlockSystem;

/// cone_newton for A = G G^T: the same Newton's method, on a system in the columns of G
/// (block_system.hpp). `start`: a z in the problem's units, or null. The report's solver is
/// cone_newton. Errors: those of check(), and a start that does not fit.
Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start);

/// The same on a system that has been made already.
LcpSolution block_newton_on(BlockSystem& system, const LcpOptions& options, const VecX* start);

}  // namespace tumble::lcp
