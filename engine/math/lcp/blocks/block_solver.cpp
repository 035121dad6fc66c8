#include "engine/math/lcp/blocks/block_solver.hpp"

#include "engine/math/lcp/blocks/block_interior.hpp"
#include "engine/math/lcp/blocks/block_newton.hpp"

#include <algorithm>
#include <utility>

namespace tumble::lcp {
namespace {

constexpr double sharp = 1e-12;       ///< residual that is sought
constexpr int first_systems = 60;     ///< after which Newton's method has stalled
constexpr int patient_systems = 400;  ///< where nothing else answers

/// Status and w of an answer by a tolerance other than its own.
void judge_again(const BlockProblem& problem, double tolerance, LcpSolution& s) {
  s.report.status = LcpStatus::solved;
  settle(problem, tolerance, s);
  if (!s.report.solved()) s.report.status = LcpStatus::max_iterations;
}

}  // namespace

Result<LcpSolution> solve_blocks(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start) {
  LcpOptions asked;
  asked.tolerance = std::min(sharp, options.tolerance);
  asked.max_iterations = first_systems;
  Result<LcpSolution> best = block_newton(problem, asked, start);
  if (!best || best->report.solved()) return best;
  const auto better = [&](Result<LcpSolution> other) {
    if (other && other->report.residual < best->report.residual) best = std::move(other);
    judge_again(problem, options.tolerance, *best);
    return best->report.solved();
  };
  asked.max_iterations = 0;
  if (better(block_interior(problem, asked))) return best;
  asked.max_iterations = patient_systems;
  better(block_newton(problem, asked, start));
  return best;
}

}  // namespace tumble::lcp
