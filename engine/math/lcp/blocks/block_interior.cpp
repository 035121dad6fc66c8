#include "engine/math/lcp/blocks/block_interior.hpp"

#include "engine/math/lcp/blocks/block_newton.hpp"
#include "engine/math/lcp/blocks/block_system.hpp"
#include "engine/math/lcp/interior/path_follower.hpp"

namespace tumble::lcp {
namespace {

constexpr int most_block_polish = 40;       ///< systems
constexpr double block_path_weight = 1e-7;  ///< of a diagonal of about 1

}  // namespace

Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  BlockSystem system(problem);
  LcpOptions few = options;
  few.max_iterations = most_block_polish;
  return solve_along_path(system, options,
                          {block_path_weight, options.tolerance,
                           [&](const VecX& z) { return block_newton_on(system, few, &z); }});
}

}  // namespace tumble::lcp
