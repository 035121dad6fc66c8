#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The method of cone_interior for A = G G^T, with linear systems in the columns of G, as
/// block_newton has them: its cost is that of a few Newton steps per contact. The report's solver
/// is cone_interior. Errors: those of check().
Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
