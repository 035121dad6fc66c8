#include "engine/math/lcp/sweep/pgs.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/lcp/system/dense_system.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <cmath>

namespace tumble::lcp {

Result<LcpSolution> pgs(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  DenseSystem system(problem);
  const int n = problem.size();
  const int limit = n == 0 ? 0 : options.max_iterations > 0 ? options.max_iterations : 2000;
  LcpSolution out;
  out.report.solver = "pgs";
  out.z = VecX::Zero(n);
  VecX z = system.rest();
  system.start_sweeps(z);
  for (int k = 1; k <= limit && !stop_requested(); ++k) {
    const double moved = system.sweep(z);
    out.report.iterations = k;
    if (!std::isfinite(moved)) {
      out.report.status = LcpStatus::numeric;
      break;
    }
    const bool still = moved <= tolerances::sweep_still * z.cwiseAbs().maxCoeff();
    if (k % 10 != 0 && k != limit && !still) continue;
    out.z = system.in_own_units(z);
    if (validate(problem, out.z).worst() <= options.tolerance) {
      out.report.status = LcpStatus::solved;
      break;
    }
    system.start_sweeps(z);
  }
  if (n == 0) out.report.status = LcpStatus::solved;
  grade(problem, options.tolerance, out);
  return out;
}

}  // namespace tumble::lcp
