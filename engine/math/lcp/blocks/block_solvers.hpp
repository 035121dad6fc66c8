#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// cone_newton for A = G G^T: the same Newton's method, on a system in the columns of G
/// (block_system.hpp). `start`: a z in the problem's units, or null. The report's solver is
/// cone_newton. Errors: those of check(), and a start that does not fit.
Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start);

/// cone_interior for A = G G^T: the same path, on the same system; its cost is that of a few Newton
/// steps per contact. The report's solver is cone_interior. Errors: those of check().
Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
