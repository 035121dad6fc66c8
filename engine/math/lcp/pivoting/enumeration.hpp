#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The reference: tries every assignment of places (lower, between, upper), in lexicographic order,
/// and returns the first that satisfies all conditions. For general matrices, bounds and sliding
/// groups. `infeasible` if none does and no set of between unknowns had a singular matrix, or if A
/// is symmetric and without groups (a semi-definite problem with a solution then has one on a
/// regular set); else `singular`. Errors: those of check(); unsupported for more than 3^12
/// assignments, and for undecided groups.
Result<LcpSolution> enumeration(const LcpProblem& problem, const LcpOptions& options = {});

/// Whether there are at most 8 unknowns that are not lateral, so that this is fast.
bool is_quick_to_enumerate(const LcpProblem& problem);

}  // namespace tumble::lcp
