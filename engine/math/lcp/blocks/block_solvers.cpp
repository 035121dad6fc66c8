#include "engine/math/lcp/blocks/block_solvers.hpp"

#include "engine/math/lcp/blocks/block_system.hpp"
#include "engine/math/lcp/interior/path_follower.hpp"
#include "engine/math/lcp/newton/semismooth_newton.hpp"
#include "engine/math/lcp/tolerances.hpp"

namespace tumble::lcp {
namespace {

constexpr NewtonLimits block_limits{40, 400, 2600};

}  // namespace

Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start) {
  if (Status c = check(problem); !c) return c.error();
  if (start)
    if (Status c = check_start(problem.conditions, *start); !c) return c.error();
  BlockSystem system(problem);
  SemismoothNewton newton(system, block_limits, options);
  const VecX z = start ? system.in_scaled_units(*start) : system.rest();
  const bool done = system.size() == 0 || (start && (newton.consider(z) || newton.attempt(z))) ||
                    newton.attempt_inside();  // from where no cone matters, which is mostly near
  // A result that is good enough is not searched for again from another start.
  if (!done && newton.best().residual > options.tolerance) newton.attempt_after_sweeps(z);
  return newton.answer(options);
}

Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  BlockSystem system(problem);
  return solve_along_path(system, options, tolerances::block_path_weight, options.tolerance);
}

}  // namespace tumble::lcp
