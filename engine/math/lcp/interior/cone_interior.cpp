#include "engine/math/lcp/interior/cone_interior.hpp"

#include "engine/math/lcp/interior/path_follower.hpp"
#include "engine/math/lcp/system/dense_system.hpp"
#include "engine/math/lcp/tolerances.hpp"

namespace tumble::lcp {
Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  DenseSystem system(problem);
  return solve_along_path(system, options, tolerances::dense_path_weight, 0.1 * options.tolerance);
}

}  // namespace tumble::lcp
