#pragma once
#include "engine/math/lcp/pivoting/pivot_trace.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Principal pivoting for a symmetric positive semi-definite A with bounds, without groups.
///
/// An unknown whose w has the wrong sign is driven: it moves by itself, the unknowns between their
/// bounds follow so that their w stays 0, until its w vanishes, it meets its other bound, or
/// another unknown has to change places first (Cottle & Dantzig 1968; for bounds and one unknown at
/// a time Baraff 1994; Coutinho §14.2). Where the driven w does not change (a zero Schur
/// complement), A d = 0 along the direction, and the motion ends at a bound of another unknown or
/// proves the problem infeasible, with d in `ray`. Semi-definite problems need no regularisation.
///
/// The start is every b of the wrong sign, bettered by exchanging all wrong unknowns at once while
/// that helps (Júdice & Pires 1994); the pivots above begin where it ends. Ties go to the larger
/// pivot, after a repetition to the least index; a second one ends with `cycling`.
///
/// L D L^T of the unknowns between bounds follows each exchange in O(n^2). Errors: those of check()
/// and check_symmetric(); unsupported when there are groups.
Result<LcpSolution> dantzig(const LcpProblem& problem, const LcpOptions& options = {});

/// The same without the start in blocks, one unknown driven after the other, with the state after
/// each stop of a driven one.
Result<LcpSolution> watch_dantzig(const LcpProblem& problem, PivotTrace& trace,
                                  const LcpOptions& options = {});

}  // namespace tumble::lcp
