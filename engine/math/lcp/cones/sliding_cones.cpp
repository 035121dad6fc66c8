#include "engine/math/lcp/cones/sliding_cones.hpp"

#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>

namespace tumble::lcp {
bool slides(const LcpProblem& problem) {
  return std::any_of(problem.groups.begin(), problem.groups.end(),
                     [](const ConeGroup& g) { return g.mode == ConeMode::sliding; });
}

bool balances(const LcpProblem& problem, const LcpSolution& solution) {
  const double alone = term_unit(problem, VecX::Zero(problem.size()));
  return solution.report.residual * term_unit(problem, solution.z) <=
         tolerances::off_balance * alone;
}

Result<LcpSolution> solve_from_fast_slip(const LcpProblem& problem, bool few) {
  LcpProblem fast = problem;
  const double speed = tolerances::fast_slip * problem.b.cwiseAbs().maxCoeff();
  for (ConeGroup& g : fast.groups) {
    if (g.mode != ConeMode::sliding) continue;
    g.mode = ConeMode::undecided;
    for (size_t k = 0; k < 2; ++k) fast.b[g.lateral[k]] += speed * g.direction[k];
  }
  Result<LcpSolution> start = few ? cone_newton(fast) : cone_interior(fast);
  if (!start || !start->report.solved()) return start;
  return cone_newton_from(problem, {}, start->z);
}

}  // namespace tumble::lcp
