#pragma once
#include "engine/math/lcp/pivoting/pivot_trace.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Principal pivoting for a symmetric positive semi-definite A with bounds, without groups.
///
/// An unknown whose w has the wrong sign is driven: it moves, and the unknowns between their bounds
/// follow so that their w stays 0, until its w vanishes, it reaches its other bound, or another
/// unknown has to be exchanged first (Cottle & Dantzig 1968; for bounds and one unknown at a time
/// Baraff 1994; Coutinho §14.2). If the driven w does not change (a zero Schur complement), then A
/// d = 0 along the direction d, and the motion ends at a bound of another unknown or proves the
/// problem infeasible, with d in `ray`. Semi-definite problems need no regularisation.
///
/// The initial set has every b of the wrong sign, improved by exchanging all violated unknowns at
/// once while that helps (Júdice & Pires 1994); the pivots above follow. Ties are broken by the
/// larger pivot, after a repetition by the least index; a second repetition ends with `cycling`.
///
/// L D L^T of the unknowns between bounds is updated with each exchange in O(n^2). Errors: those of
/// check() and check_symmetric(); unsupported for groups.
Result<LcpSolution> dantzig(const LcpProblem& problem, const LcpOptions& options = {});

/// The same without the block start, recording the state after each stop of a driven unknown.
Result<LcpSolution> watch_dantzig(const LcpProblem& problem, PivotTrace& trace,
                                  const LcpOptions& options = {});

}  // namespace tumble::lcp
