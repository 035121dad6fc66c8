// Linear complementarity against Bullet's Dantzig solver (Debian builds it in single precision):
// random definite matrices; a column of boxes with four axial unknowns a layer, semi-definite; and,
// without a peer, the same column with cones. The answer is the greatest residual by our validator,
// 1 where the solver reports failure. Argument: the greatest n (default 200).
#include "engine/math/lcp/least/minimum_norm.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/baraff.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/bench/contest.hpp"
#include "tests/math/lcp_families.hpp"

#include <cstdlib>

#include <BulletDynamics/MLCPSolvers/btDantzigLCP.h>

using namespace tumble;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

/// A z = b + w in Bullet's convention; rows padded to four.
double by_bullet(const LcpProblem& p) {
  const int n = p.size(), stride = (n + 3) & ~3;
  std::vector<btScalar> a(size_t(n) * size_t(stride)), z(static_cast<size_t>(n)), b(z), w(z),
      low(z), high(z);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a[size_t(i) * size_t(stride) + size_t(j)] = btScalar(p.A(i, j));
    b[size_t(i)] = btScalar(-p.b[i]);
    low[size_t(i)] = 0;
    high[size_t(i)] = SIMD_INFINITY;
  }
  btDantzigScratchMemory scratch;
  if (!btSolveDantzigLCP(n, a.data(), z.data(), b.data(), w.data(), 0, low.data(), high.data(),
                         nullptr, scratch))
    return 1;
  VecX out(n);
  for (int i = 0; i < n; ++i) out[i] = double(z[size_t(i)]);
  return std::min(1.0, validate(p, out).worst());
}

double residual_of(const Result<LcpSolution>& s) {
  return s.ok() && s->report.solved() ? s->report.residual : 1;
}

void contest_of(const std::string& title, const std::vector<LcpProblem>& problems) {
  const auto worst = [&](auto solve) {
    double most = 0;
    for (const LcpProblem& p : problems) most = std::max(most, solve(p));
    return most;
  };
  bench::report(
      title,
      {{"Bullet", [&] { return worst(by_bullet); }},
       {"tumble",
        [&] { return worst([](const LcpProblem& p) { return residual_of(dantzig(p)); }); }}},
      15);
}

void cones(int layers) {
  const LcpProblem p = boxes_with_cones(layers, 0.5);
  bench::report(
      "column of " + std::to_string(layers) + " boxes, " + std::to_string(4 * layers) + " cones",
      {{"cone_newton", [&] { return residual_of(cone_newton(p)); }},
       {"baraff", [&] { return residual_of(baraff(p)); }},
       {"cone_newton, least norm", [&] { return residual_of(minimum_norm(p, *cone_newton(p))); }}},
      5);
}

}  // namespace

int main(int argc, char** argv) {
  const int most = argc > 1 ? std::atoi(argv[1]) : 200;
  for (const int n : {24, 48, 96, 200, 500}) {
    if (n > most) break;
    Random r(5);
    std::vector<LcpProblem> problems;
    for (int k = 0; k < std::max(4, 400 / n); ++k) problems.push_back(make(r, n, definite));
    contest_of(
        "definite, n = " + std::to_string(n) + ", " + std::to_string(problems.size()) + " of them",
        problems);
  }
  for (const int layers : {3, 6, 12, 24, 50}) {
    if (4 * layers > most) break;
    contest_of("column of " + std::to_string(layers) + " boxes, n = " + std::to_string(4 * layers),
               {column_of_boxes(layers)});
  }
  for (const int layers : {3, 12, 25})
    if (12 * layers <= most * 2) cones(layers);
}
