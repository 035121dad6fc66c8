#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// cone_interior for A = G G^T: the same path, on a system in the columns of G (block_system.hpp);
/// its cost is that of a few Newton steps per contact. The report's solver is cone_interior.
/// Errors: those of check().
Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
