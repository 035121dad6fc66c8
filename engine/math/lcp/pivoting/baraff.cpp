#include "engine/math/lcp/pivoting/baraff.hpp"

#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/pivoting/lemke.hpp"
#include "engine/math/lcp/pivoting/pivot_driver.hpp"
#include "engine/math/lcp/pivoting/standard_form.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>

namespace tumble::lcp {
namespace {

/// Whether enumeration of all assignments proves that there is no solution.
bool refuted(const LcpProblem& problem) {
  if (!is_quick_to_enumerate(problem)) return false;
  const auto all = enumeration(problem);
  return all.ok() && all->report.status == LcpStatus::infeasible;
}

/// baraff(), with or without a trace.
Result<LcpSolution> pivot_with_cones(const LcpProblem& problem, const LcpOptions& options,
                                     PivotTrace* trace) {
  if (Status c = check(problem); !c) return c.error();
  if (Status c = check_symmetric(problem); !c) return c.error();
  if (problem.groups.empty()) {
    Result<LcpSolution> plain =
        trace ? watch_dantzig(problem, *trace, options) : dantzig(problem, options);
    if (plain) plain->report.solver = "baraff";
    return plain;
  }
  LcpSolution out;
  out.report.solver = "baraff";
  PivotState state(ScaledProblem(problem), problem.groups);
  PivotDriver driver(
      state, options.max_iterations > 0 ? options.max_iterations : 20 * state.n + 200, trace);
  out.report.status = driver.run();
  out.report.iterations = state.pivots;
  if (out.report.status == LcpStatus::ray) out.ray = driver.ray;
  out.z = state.in_own_units(state.z);
  if (out.report.solved()) polish(problem, options, out);
  if (trace) trace->polished = out.report.solved();
  grade(problem, options.tolerance, out);
  if (out.report.solved()) return out;
  LcpOptions rest = options;
  rest.max_iterations = 0;
  auto other = all_slide(problem) ? lemke(problem, rest) : cone_newton(problem, rest);
  if (other.ok() && other->report.solved()) {
    other->report.iterations += out.report.iterations;
    return other;
  }
  if (other.ok() && other->report.status == LcpStatus::ray) {
    out.report.status = LcpStatus::ray;
    out.ray = other->ray;
  }
  if (out.report.status == LcpStatus::ray && refuted(problem))
    out.report.status = LcpStatus::infeasible;
  return out;
}

}  // namespace

Result<LcpSolution> baraff(const LcpProblem& problem, const LcpOptions& options) {
  return pivot_with_cones(problem, options, nullptr);
}

Result<LcpSolution> watch_baraff(const LcpProblem& problem, PivotTrace& trace,
                                 const LcpOptions& options) {
  trace = {};
  return pivot_with_cones(problem, options, &trace);
}

}  // namespace tumble::lcp
