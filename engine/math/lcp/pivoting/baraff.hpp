#pragma once
#include "engine/math/lcp/pivoting/pivot_trace.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Baraff's pivoting with cones ("Fast contact force computation for nonpenetrating rigid bodies",
/// SIGGRAPH 1994; Coutinho §14.3): as dantzig(), with conditions on lateral unknowns in addition to
/// those on axial ones. Undecided groups: laterals are driven along one direction at a time until
/// their w vanishes or the cone is reached; on the cone they keep their direction until pivoting
/// ends, and are then turned against their w by Newton's method (polish()). Sliding groups: the
/// laterals follow their axial unknowns, which makes the matrix unsymmetric. Without groups it is
/// dantzig().
///
/// Pivoting with cones need not terminate, nor need a solution exist. After a repeated set, a
/// singular one, the limit of pivots, or directions that do not converge, cone_newton() is used,
/// and for sliding groups alone lemke(); the report names the one that gave the result. If a motion
/// is not stopped by anything and they find no solution either, the status is `ray`, with the
/// direction in `ray`; or `infeasible`, if enumeration of a few sliding groups proves that there is
/// none. The factorisation is recomputed for each pivot: O(n^3). Errors: those of check() and
/// check_symmetric().
Result<LcpSolution> baraff(const LcpProblem& problem, const LcpOptions& options = {});

/// The same, recording the state after each stop of a driven unknown; for a problem without groups
/// as watch_dantzig().
Result<LcpSolution> watch_baraff(const LcpProblem& problem, PivotTrace& trace,
                                 const LcpOptions& options = {});

}  // namespace tumble::lcp
