#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The reference: tries every assignment of places (lower, between, upper), in lexicographic order,
/// and takes the first whose answer satisfies all conditions. For general matrices, bounds and
/// sliding groups.
/// `infeasible` when none does and no set of between unknowns had a singular matrix, or A is
/// symmetric and without groups (where a semi-definite problem with a solution has one on a regular
/// set); else `singular`. Errors: those of check(); unsupported for more than 3^12 assignments, and
/// for undecided groups.
Result<LcpSolution> enumeration(const LcpProblem& problem, const LcpOptions& options = {});

/// Whether there are so few unknowns beside lateral ones, at most 8, that this is quick.
bool is_quick_to_enumerate(const LcpProblem& problem);

}  // namespace tumble::lcp
