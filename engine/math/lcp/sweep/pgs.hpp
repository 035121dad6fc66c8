#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Projected Gauss-Seidel: sweeps until the residual is within the tolerance, at most
/// `max_iterations` (default 2000). For bounds and cones of all kinds; converges for semi-definite
/// A without groups, at a rate that depends on the condition of A, and usually with groups (Cottle,
/// Pang & Stone §5.2). Errors: those of check().
Result<LcpSolution> pgs(const LcpProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
