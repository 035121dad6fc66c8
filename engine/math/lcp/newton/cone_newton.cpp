#include "engine/math/lcp/newton/cone_newton.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/lcp/newton/semismooth_newton.hpp"
#include "engine/math/lcp/pivoting/ldl.hpp"
#include "engine/math/lcp/system/dense_system.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr NewtonLimits dense_limits{60, 1000, 20000};
constexpr NewtonLimits polish_limits{60, 60, 0};

/// L D L^T of the rows of groups and of free unknowns, regularised; false if some of them are
/// dependent.
bool factor_inside(const DenseSystem& system, LdlFactor& factor) {
  const ScaledProblem& p = system.scaled();
  std::vector<char> equation(size_t(p.n), 0);
  for (const ConeUnit& unit : system.parts())
    for (size_t r = 0; r < size_t(unit.count); ++r)
      equation[size_t(unit.row[r])] =
          unit.group || (std::isinf(unit.lower) && std::isinf(unit.upper));
  factor.reset(p.n);
  std::vector<double> y(static_cast<size_t>(p.n));
  for (int i = 0; i < p.n; ++i) {
    if (!equation[size_t(i)]) continue;
    if (stop_requested()) return false;
    const auto& members = factor.members();
    for (size_t k = 0; k < members.size(); ++k) y[k] = p.column(i)[members[k]];
    factor.forward(y.data());
    const double left = factor.remainder(p.at(i, i) + SemismoothNewton::usual_weight, y.data());
    if (!(left > tolerances::lost_row)) return false;
    factor.append(i, y.data(), left);
  }
  return true;
}

/// The solution with all those rows as equations, which solves the problem if no cone and no bound
/// is active, by one symmetric factorisation; iterative refinement removes the regularisation. True
/// if it is the solution.
bool start_inside(DenseSystem& system, SemismoothNewton& newton, VecX& z) {
  LdlFactor factor;
  if (!factor_inside(system, factor)) return false;
  ++system.systems;
  const auto& members = factor.members();
  std::vector<double> y(static_cast<size_t>(system.size()));
  VecX w(z.size());
  for (int pass = 0; pass < tolerances::most_refinements; ++pass) {
    const double before = newton.best().residual;
    system.slack(z, w);
    for (size_t k = 0; k < members.size(); ++k) y[k] = -w[members[k]];
    factor.solve(y.data());
    for (size_t k = 0; k < members.size(); ++k) z[members[k]] += y[k];
    if (newton.consider(z)) return true;
    const double now = newton.best().residual;
    if (pass == 0 ? now > tolerances::refinable_residual : now > tolerances::refined_share * before)
      break;
  }
  return false;
}

bool solve_cold(DenseSystem& system, SemismoothNewton& newton) {
  const VecX rest = system.rest();
  if (!system.conditions().groups.empty()) {
    VecX z = rest;
    if (start_inside(system, newton, z)) return true;
    if (newton.attempt(z)) return true;
  }
  return newton.attempt(rest);
}

Result<LcpSolution> solve_dense(const LcpProblem& problem, const LcpOptions& options,
                                const VecX* start) {
  if (Status c = check(problem); !c) return c.error();
  if (start)
    if (Status c = check_start(problem, *start); !c) return c.error();
  DenseSystem system(problem);
  SemismoothNewton newton(system, dense_limits, options);
  const VecX z = start ? system.in_scaled_units(*start) : system.rest();
  const bool done = system.size() == 0 || (start ? newton.attempt(z) : solve_cold(system, newton));
  if (!done) newton.attempt_after_sweeps(z);
  return newton.answer(options);
}

}  // namespace

Result<LcpSolution> cone_newton(const LcpProblem& problem, const LcpOptions& options) {
  return solve_dense(problem, options, nullptr);
}

Result<LcpSolution> cone_newton_from(const LcpProblem& problem, const LcpOptions& options,
                                     const VecX& z) {
  return solve_dense(problem, options, &z);
}

void polish(const LcpProblem& problem, const LcpOptions& options, LcpSolution& solution) {
  if (problem.size() == 0) return;
  DenseSystem system(problem);
  LcpOptions few = options;
  few.max_iterations = 0;
  SemismoothNewton newton(system, polish_limits, few);
  const VecX z = system.in_scaled_units(solution.z);
  if (!newton.consider(z)) newton.attempt(z);
  solution.z = newton.best().z;
  solution.report.iterations += system.systems;
}

}  // namespace tumble::lcp
