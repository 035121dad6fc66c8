#include "engine/math/lcp/pivoting/baraff.hpp"

#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/cone_driver.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/pivoting/lemke.hpp"
#include "engine/math/lcp/pivoting/standard_form.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

/// Puts a clamped unknown that is beyond its bound or cone on it; true if there was one.
bool pull_back(ConePivots& s) {
  bool changed = false;
  const double tolerance = s.tolerance();
  for (int i = 0; i < s.n; ++i) {
    if (s.group_of[size_t(i)] >= 0 || s.role[size_t(i)] != Role::clamped) continue;
    const bool below = s.z[i]<s.lower[i] - tolerance, above = s.z[i]> s.upper[i] + tolerance;
    if (!below && !above) continue;
    s.role[size_t(i)] = Role::at_bound;
    s.place[size_t(i)] = below ? Place::lower : Place::upper;
    s.z[i] = below ? s.lower[i] : s.upper[i];
    changed = true;
  }
  for (auto& g : s.groups) {
    if (g.open(s)) continue;
    const double a = s.z[g.cone.axial], radius = g.cone.slope * a + tolerance;
    if (a < -tolerance) {
      s.open(g);
      changed = true;
      continue;
    }
    if (g.prescribed()) continue;
    const int i = g.cone.lateral[0], j = g.cone.lateral[1];
    if (g.round()) {
      if (s.role[size_t(i)] == Role::tied) continue;
      if (std::sqrt(s.z[i] * s.z[i] + s.z[j] * s.z[j]) <= radius) continue;
      s.tie_along_z(g);
      changed = true;
      continue;
    }
    for (size_t k = 0; k < 2; ++k) {
      const int t = g.cone.lateral[k];
      if (s.role[size_t(t)] == Role::tied || std::fabs(s.z[t]) <= radius) continue;
      g.tie[k] = s.z[t] > 0 ? g.cone.slope : -g.cone.slope;
      s.role[size_t(t)] = Role::tied;
      changed = true;
    }
  }
  return changed;
}

bool settle_inside(ConePivots& s) {
  for (int k = 0; k < 2 * s.n + 10; ++k) {
    if (!s.solve()) return false;
    if (!pull_back(s)) return true;
  }
  return false;
}

/// Pivots and turns in alternation.
void run_baraff(const LcpProblem& problem, const LcpOptions& options, LcpSolution& out) {
  ConePivots state(problem);
  const int limit = options.max_iterations > 0 ? options.max_iterations : 20 * state.n + 200;
  ConeDriver driver(state, limit);
  double best = std::numeric_limits<double>::infinity();
  out.z = VecX::Zero(state.n);
  for (int round = 0; round < 200; ++round) {
    std::fill(state.excused.begin(), state.excused.end(), char(0));
    out.report.status = driver.run();
    if (!out.report.solved()) break;
    if (!settle_inside(state)) {
      out.report.status = LcpStatus::numeric;
      break;
    }
    const VecX z = state.answer(false, state.z);
    const double residual = validate(problem, z).worst();
    const bool better = residual < best;
    if (better) {
      best = residual;
      out.z = z;
    }
    if (best <= 1e-13 ||
        (best <= std::min(1e-9, options.tolerance) && residual > 0.5 * best && !better))
      break;
    state.align();
    if (!settle_inside(state)) break;
  }
  if (best <= options.tolerance)
    out.report.status = LcpStatus::solved;
  else if (out.report.solved())
    out.report.status = LcpStatus::max_iterations;
  out.report.iterations = driver.pivots;
  if (out.report.status == LcpStatus::ray) out.ray = driver.ray;
  for (int i = 0; i < state.n; ++i)
    out.places.push_back(state.role[size_t(i)] == Role::at_bound ? state.place[size_t(i)]
                                                                 : Place::between);
}

bool only_sliding(const LcpProblem& p) {
  for (const ConeGroup& g : p.groups)
    if (g.mode != ConeMode::sliding) return false;
  return true;
}

/// For problems without undecided groups: whether trying all assignments proves that there is no
/// solution.
bool refuted(const LcpProblem& problem) {
  const StandardForm form(problem);
  if (form.size > 10) return false;
  MatX m(form.size, form.size);
  VecX q(form.size);
  for (int i = 0; i < form.size; ++i) {
    q[i] = form.q[size_t(i)];
    for (int j = 0; j < form.size; ++j) m(i, j) = form.M[size_t(i) * size_t(form.size) + size_t(j)];
  }
  const auto all = enumeration(LcpProblem::plain(std::move(m), std::move(q)));
  return all.ok() && all->report.status == LcpStatus::infeasible;
}

}  // namespace

Result<LcpSolution> baraff(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  if (Status c = check_symmetric(problem); !c) return c.error();
  LcpSolution out;
  out.report.solver = "baraff";
  run_baraff(problem, options, out);
  settle(problem, options.tolerance, out);
  if (out.report.solved()) return out;
  LcpOptions rest = options;
  rest.max_iterations = 0;
  rest.start.clear();
  auto other = only_sliding(problem) ? lemke(problem, rest) : cone_newton(problem, rest);
  if (other.ok() && other->report.solved()) {
    other->report.iterations += out.report.iterations;
    return other;
  }
  if (other.ok() && other->report.status == LcpStatus::ray) {
    out.report.status = LcpStatus::ray;
    out.ray = other->ray;
  }
  if (out.report.status == LcpStatus::ray && only_sliding(problem)) {
    const bool proved =
        problem.groups.empty() ? ray_residual(problem, out.ray) < 1e-9 : refuted(problem);
    if (proved) out.report.status = LcpStatus::infeasible;
  }
  return out;
}

}  // namespace tumble::lcp
