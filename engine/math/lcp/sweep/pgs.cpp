#include "engine/math/lcp/sweep/pgs.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/lcp/sweep/sweep.hpp"
#include "engine/math/lcp/validate.hpp"

#include <cmath>

namespace tumble::lcp {

Result<LcpSolution> pgs(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  const ScaledProblem scaled(problem);
  Sweeper sweeper(problem, scaled);
  const int limit = scaled.n == 0 ? 0 : options.max_iterations > 0 ? options.max_iterations : 2000;
  LcpSolution out;
  out.report.solver = "pgs";
  out.z = VecX::Zero(scaled.n);
  for (int k = 1; k <= limit && !stop_requested(); ++k) {
    const double moved = sweeper.sweep();
    out.report.iterations = k;
    if (!std::isfinite(moved)) {
      out.report.status = LcpStatus::numeric;
      break;
    }
    const bool still = moved <= 1e-16 * sweeper.z.cwiseAbs().maxCoeff();
    if (k % 10 != 0 && k != limit && !still) continue;
    for (int i = 0; i < scaled.n; ++i) out.z[i] = sweeper.z[i] * scaled.d[size_t(i)];
    if (validate(problem, out.z).worst() <= options.tolerance) {
      out.report.status = LcpStatus::solved;
      break;
    }
    sweeper.renew();
  }
  for (int i = 0; i < scaled.n; ++i)
    out.places.push_back(out.z[i] <= problem.lower[i]   ? Place::lower
                         : out.z[i] >= problem.upper[i] ? Place::upper
                                                        : Place::between);
  if (scaled.n == 0) out.report.status = LcpStatus::solved;
  settle(problem, options.tolerance, out);
  return out;
}

}  // namespace tumble::lcp
