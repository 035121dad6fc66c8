#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// cone_newton for A = G G^T: the same Newton's method, on a system in the columns of G
/// (block_system.hpp). `start`: initial z in the problem's units, or null. The report names
/// cone_newton as the solver. Errors: those of check(), and a start of the wrong size.
Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start);

/// cone_interior for A = G G^T: the same path, on the same system; it costs a few Newton steps per
/// contact. The report names cone_interior as the solver. Errors: those of check().
Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
