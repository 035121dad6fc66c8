#include "engine/math/lcp/pivoting/enumeration.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/math/lu.hpp"

#include <cmath>

namespace tumble::lcp {
namespace {

/// What one unknown may be: at a bound, resting at 0 (free ones only), or solved for.
struct Choice {
  Place place;
  double rest;  ///< NaN: solved for
};

std::vector<Choice> choices_of(const ScaledProblem& p, int i) {
  const bool low = std::isfinite(p.lower[i]), high = std::isfinite(p.upper[i]);
  std::vector<Choice> out;
  if (low) out.push_back({Place::lower, p.lower[i]});
  if (p.lower[i] == p.upper[i]) return out;
  if (high) out.push_back({Place::upper, p.upper[i]});
  if (!low && !high) out.push_back({Place::between, 0});
  out.push_back({Place::between, std::nan("")});
  return out;
}

/// Solves for the unknowns that `z` has as NaN; false when their matrix is singular.
bool fill_in(const ScaledProblem& p, VecX& z) {
  std::vector<int> solved;
  for (int i = 0; i < p.n; ++i)
    if (std::isnan(z[i])) solved.push_back(i);
  const int m = int(solved.size());
  std::vector<double> a(size_t(m) * size_t(m)), x(size_t(m), 0.0);
  for (int k = 0; k < m; ++k) {
    const int i = solved[size_t(k)];
    x[size_t(k)] = -p.b[i];
    for (int j = 0; j < p.n; ++j)
      if (!std::isnan(z[j])) x[size_t(k)] -= p.at(i, j) * z[j];
    for (int l = 0; l < m; ++l) a[size_t(l * m + k)] = p.at(i, solved[size_t(l)]);
  }
  LuFactor lu;
  if (m > 0 && !lu.factor(a, m, 1e-11)) return false;
  if (m > 0) lu.solve(x.data());
  for (int k = 0; k < m; ++k) z[solved[size_t(k)]] = x[size_t(k)];
  return true;
}

bool symmetric(const LcpProblem& p) {
  return check_symmetric(p).ok();
}

}  // namespace

Result<LcpSolution> enumeration(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  if (!problem.groups.empty())
    return Error{ErrorCode::unsupported, "enumeration solves no groups", "lcp", {}};
  const ScaledProblem p(problem);
  std::vector<std::vector<Choice>> choices;
  double assignments = 1;
  for (int i = 0; i < p.n; ++i) {
    choices.push_back(choices_of(p, i));
    assignments *= double(choices.back().size());
  }
  if (assignments > 531441)
    return Error{ErrorCode::unsupported, "too many assignments to enumerate", "lcp",
                 "use another solver: this one is for at most 12 unknowns"};
  LcpSolution out;
  out.report.solver = "enumeration";
  out.z = VecX::Zero(p.n);
  out.places.resize(size_t(p.n), Place::lower);
  bool skipped = false;
  std::vector<size_t> at(size_t(p.n), 0);
  for (;;) {
    VecX z(p.n);
    for (int i = 0; i < p.n; ++i) z[i] = choices[size_t(i)][at[size_t(i)]].rest;
    if (++out.report.iterations % 1024 == 0 && stop_requested()) break;
    if (!fill_in(p, z)) {
      skipped = true;
    } else {
      for (int i = 0; i < p.n; ++i) z[i] *= p.d[size_t(i)];
      if (validate(problem, z).worst() <= options.tolerance) {
        out.z = z;
        for (size_t i = 0; i < at.size(); ++i) out.places[i] = choices[i][at[i]].place;
        out.report.status = LcpStatus::solved;
        break;
      }
    }
    size_t k = 0;
    while (k < at.size() && ++at[k] == choices[k].size()) at[k++] = 0;
    if (k == at.size()) {
      out.report.status =
          skipped && !symmetric(problem) ? LcpStatus::singular : LcpStatus::infeasible;
      break;
    }
  }
  settle(problem, options.tolerance, out);
  return out;
}

}  // namespace tumble::lcp
