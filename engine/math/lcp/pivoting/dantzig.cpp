#include "engine/math/lcp/pivoting/dantzig.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/pivoting/block_start.hpp"
#include "engine/math/lcp/pivoting/pivot_driver.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>

namespace tumble::lcp {
namespace {

/// Pivoting on one problem; z in the units of the rows.
LcpStatus pivot(const ScaledProblem& scaled, int limit, LcpSolution& out,
                PivotTrace* trace = nullptr) {
  // A copy of the matrix, and room for its factor.
  charge_work(size_t(scaled.n), 2 * size_t(scaled.n));
  PivotState state(scaled, {});
  if (!trace) block_start(state);
  PivotDriver driver(state, std::max(1, limit - out.report.iterations), trace);
  const LcpStatus status = driver.run();
  if (status == LcpStatus::infeasible) out.ray = driver.ray;
  out.report.iterations += state.pivots;
  out.z = state.in_own_units(state.z.cwiseMax(scaled.lower).cwiseMin(scaled.upper));
  return status;
}

/// Pivoting fails for matrices whose small pivots are of the size of rounding. A sequence of
/// problems with `weight` times the identity added, each centred at the solution of the last, has
/// no such pivots, and the addition vanishes as it converges (Rockafellar 1976).
bool converge(const LcpProblem& problem, const ScaledProblem& scaled, int limit, LcpSolution& out) {
  constexpr double weight = tolerances::dantzig_weight;
  ScaledProblem near = scaled;
  for (int i = 0; i < scaled.n; ++i) near.A[size_t(i) * size_t(scaled.n) + size_t(i)] += weight;
  LcpSolution next = out;
  double best = std::numeric_limits<double>::infinity();
  for (int idle = 0; idle < 4 && !stop_requested();) {
    if (pivot(near, limit, next) != LcpStatus::solved) break;
    const double residual = validate(problem, next.z).worst();
    idle = residual < 0.5 * best ? 0 : idle + 1;
    if (residual < best) best = residual, out.z = next.z;
    if (best <= tolerances::best_residual) break;
    for (int i = 0; i < scaled.n; ++i)
      near.b[i] = scaled.b[i] - weight * (next.z[i] / scaled.d[size_t(i)]);
  }
  out.report.iterations = next.report.iterations;
  return best < std::numeric_limits<double>::infinity();
}

/// dantzig(), with or without a trace.
Result<LcpSolution> pivot_and_check(const LcpProblem& problem, const LcpOptions& options,
                                    PivotTrace* trace) {
  if (Status c = check(problem); !c) return c.error();
  if (!problem.groups.empty())
    return Error{ErrorCode::unsupported, "dantzig solves no groups", "lcp",
                 "use baraff or cone_newton"};
  if (Status c = check_symmetric(problem); !c) return c.error();
  const ScaledProblem scaled(problem);
  const int limit = options.max_iterations > 0 ? options.max_iterations : 50 * scaled.n + 1000;
  LcpSolution out;
  out.report.solver = "dantzig";
  LcpStatus first = pivot(scaled, limit, out, trace);
  if (first == LcpStatus::infeasible && !(ray_residual(problem, out.ray) <= tolerances::ray_proof))
    first = LcpStatus::ray;
  out.report.status = first;
  grade(problem, options.tolerance, out);
  if (out.report.solved() || first == LcpStatus::infeasible) return out;
  LcpSolution other = out;
  if (!converge(problem, scaled, limit, other)) return out;
  other.report.status = LcpStatus::solved;
  grade(problem, options.tolerance, other);
  if (!other.report.solved()) {
    out.report.iterations = other.report.iterations;
    return out;
  }
  other.ray.resize(0);
  return other;
}

}  // namespace

Result<LcpSolution> dantzig(const LcpProblem& problem, const LcpOptions& options) {
  return pivot_and_check(problem, options, nullptr);
}

Result<LcpSolution> watch_dantzig(const LcpProblem& problem, PivotTrace& trace,
                                  const LcpOptions& options) {
  trace = {};
  return pivot_and_check(problem, options, &trace);
}

}  // namespace tumble::lcp
