#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The reference: tries every assignment of places (lower, between, upper), in lexicographic order,
/// and takes the first whose answer satisfies all conditions. For general matrices without groups.
/// `infeasible` when none does and no set of between unknowns had a singular matrix, or A is
/// symmetric (where a semi-definite problem with a solution has one on a regular set); else
/// `singular`. Errors: those of check(); unsupported for more than 3^12 assignments or groups.
Result<LcpSolution> enumeration(const LcpProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
