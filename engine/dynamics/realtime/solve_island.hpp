#pragma once
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

/// Takes all `n` sub-steps of one precise island, whose rows, joints and drives have been laid out.
SolveResiduals solve_island(const SolverContext& context, SolverIsland& island, int n);

}  // namespace tumble
