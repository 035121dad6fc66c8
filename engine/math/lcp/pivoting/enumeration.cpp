#include "engine/math/lcp/pivoting/enumeration.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/pivoting/standard_form.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/math/lu.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr int few_unknowns = 8;  ///< beside lateral ones

/// The choices of one unknown: a bound, 0 (free ones only), or NaN for solving.
std::vector<double> choices_of(const ScaledProblem& p, int i) {
  const bool low = std::isfinite(p.lower[i]), high = std::isfinite(p.upper[i]);
  if (p.lower[i] == p.upper[i]) return {p.lower[i]};
  std::vector<double> out;
  if (low) out.push_back(p.lower[i]);
  if (high) out.push_back(p.upper[i]);
  if (!low && !high) out.push_back(0);
  out.push_back(std::nan(""));
  return out;
}

/// Solves for the unknowns that are NaN in `z`; false if their matrix is singular.
bool fill_in(const ScaledProblem& p, VecX& z) {
  std::vector<int> solved;
  for (int i = 0; i < p.n; ++i)
    if (std::isnan(z[i])) solved.push_back(i);
  const int m = int(solved.size());
  charge_work(solved.size() + 1, size_t(p.n));
  std::vector<double> a(size_t(m) * size_t(m)), x(size_t(m), 0.0);
  for (int k = 0; k < m; ++k) {
    const int i = solved[size_t(k)];
    x[size_t(k)] = -p.b[i];
    for (int j = 0; j < p.n; ++j)
      if (!std::isnan(z[j])) x[size_t(k)] -= p.at(i, j) * z[j];
    for (int l = 0; l < m; ++l) a[size_t(l * m + k)] = p.at(i, solved[size_t(l)]);
  }
  LuFactor lu;
  if (m > 0 && !lu.factor(a, m, tolerances::lost_enumerated_pivot)) return false;
  if (m > 0) lu.solve(x.data());
  for (int k = 0; k < m; ++k) z[solved[size_t(k)]] = x[size_t(k)];
  return true;
}

}  // namespace

Result<LcpSolution> enumeration(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  if (!all_slide(problem))
    return Error{ErrorCode::unsupported, "enumeration solves sliding groups only", "lcp", {}};
  ScaledProblem p(problem);
  const std::vector<char> lateral = fold_sliding(problem, p);
  std::vector<std::vector<double>> choices;
  double assignments = 1;
  for (int i = 0; i < p.n; ++i) {
    choices.push_back(lateral[size_t(i)] ? std::vector<double>{0} : choices_of(p, i));
    assignments *= double(choices.back().size());
  }
  if (assignments > tolerances::most_assignments)
    return Error{ErrorCode::unsupported, "too many assignments to enumerate", "lcp",
                 "use another solver: this one is for at most 12 unknowns"};
  LcpSolution out;
  out.report.solver = "enumeration";
  out.z = VecX::Zero(p.n);
  bool skipped = false;
  std::vector<size_t> at(size_t(p.n), 0);
  for (;;) {
    charge_work(size_t(p.n), 20);
    VecX z(p.n);
    for (int i = 0; i < p.n; ++i) z[i] = choices[size_t(i)][at[size_t(i)]];
    ++out.report.iterations;
    if (stop_requested()) break;
    if (!fill_in(p, z)) {
      skipped = true;
    } else {
      charge_work(size_t(p.n), size_t(p.n));
      for (int i = 0; i < p.n; ++i) z[i] *= p.d[size_t(i)];
      set_sliding(problem, z);
      if (validate(problem, z).worst() <= options.tolerance) {
        out.z = z;
        out.report.status = LcpStatus::solved;
        break;
      }
    }
    size_t k = 0;
    while (k < at.size() && ++at[k] == choices[k].size()) at[k++] = 0;
    if (k == at.size()) {
      const bool decided = !skipped || (problem.groups.empty() && check_symmetric(problem).ok());
      out.report.status = decided ? LcpStatus::infeasible : LcpStatus::singular;
      break;
    }
  }
  grade(problem, options.tolerance, out);
  return out;
}

bool is_quick_to_enumerate(const LcpProblem& problem) {
  return all_slide(problem) && problem.size() - 2 * int(problem.groups.size()) <= few_unknowns;
}

}  // namespace tumble::lcp
