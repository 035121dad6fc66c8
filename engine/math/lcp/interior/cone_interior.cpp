#include "engine/math/lcp/interior/cone_interior.hpp"

#include "engine/math/lcp/interior/path_follower.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/system/dense_system.hpp"

namespace tumble::lcp {
namespace {

constexpr int most_polish = 60;             ///< systems
constexpr double dense_path_weight = 1e-8;  ///< of a diagonal of about 1

}  // namespace

Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  DenseSystem system(problem);
  LcpOptions few = options;
  few.max_iterations = most_polish;
  return solve_along_path(system, options,
                          {dense_path_weight, 0.1 * options.tolerance,
                           [&](const VecX& z) { return cone_newton_on(system, few, &z); }});
}

}  // namespace tumble::lcp
