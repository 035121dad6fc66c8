#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Lemke's complementary pivoting with the lexicographic ratio test, which cannot cycle (Lemke
/// 1965; Cottle, Pang & Stone §4.4 and 4.9), on a dense tableau: for general matrices, bounds and
/// sliding groups. Solves or proves infeasible every problem with a semi-definite A; for others
/// `ray` proves nothing. Meant for comparison and for matrices that are not symmetric: O(n^2) per
/// pivot with three times the memory of dantzig(). Errors: those of check(); unsupported for
/// undecided groups.
Result<LcpSolution> lemke(const LcpProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
