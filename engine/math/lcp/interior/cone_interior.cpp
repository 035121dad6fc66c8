#include "engine/math/lcp/interior/cone_interior.hpp"

#include "engine/math/lcp/interior/path_follower.hpp"
#include "engine/math/lcp/system/dense_system.hpp"

namespace tumble::lcp {
namespace {

constexpr double dense_path_weight = 1e-8;  ///< of a diagonal of about 1

}  // namespace

Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  DenseSystem system(problem);
  return solve_along_path(system, options, dense_path_weight, 0.1 * options.tolerance);
}

}  // namespace tumble::lcp
