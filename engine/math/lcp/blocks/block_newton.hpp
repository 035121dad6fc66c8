#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// The method of cone_newton for A = G G^T, with linear systems in the columns of G rather than in
/// its rows: the Newton step P dz + Q (A + e) dz = -F, with P and Q diagonal but for groups, has
/// a = G^T dz from (1 + G^T D G) a = -G^T E^-1 F with E = P + e Q, D = E^-1 Q (Woodbury), whose
/// matrix is as sparse as the graph of blocks that share rows, and has no redundant rows. As long
/// as no unknown changes its place the factorisation is kept. `start`: a z in the problem's units,
/// or null. The report's solver is cone_newton. Errors: those of check().
Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start);

}  // namespace tumble::lcp
