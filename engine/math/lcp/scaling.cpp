#include "engine/math/lcp/scaling.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

double unit_of(double diagonal) {
  if (!(diagonal > 0)) return 1;
  int exponent;
  std::frexp(diagonal, &exponent);                                        // in [2^(e-1), 2^e)
  const int half = exponent >= 0 ? exponent / 2 : -((1 - exponent) / 2);  // floor
  return std::ldexp(1.0, std::clamp(-half, -400, 400));
}

}  // namespace

std::vector<double> scaling_of(const LcpProblem& p) {
  std::vector<double> diagonal(size_t(p.size()));
  for (int i = 0; i < p.size(); ++i) diagonal[size_t(i)] = p.A(i, i);
  return scaling_of(std::move(diagonal), p.groups);
}

std::vector<double> scaling_of(std::vector<double> diagonal, const std::vector<ConeGroup>& groups) {
  for (const ConeGroup& g : groups) {
    const auto a = size_t(g.axial), s = size_t(g.lateral[0]), t = size_t(g.lateral[1]);
    diagonal[a] = diagonal[s] = diagonal[t] = std::max({diagonal[a], diagonal[s], diagonal[t]});
  }
  for (double& x : diagonal) x = unit_of(x);
  return diagonal;
}

ScaledProblem::ScaledProblem(const LcpProblem& p)
    : n(p.size()), d(scaling_of(p)), A(size_t(n) * size_t(n)), b(n), lower(n), upper(n) {
  for (int j = 0; j < n; ++j) {
    const double* from = p.A.data() + std::ptrdiff_t(j) * n;
    double* to = A.data() + std::ptrdiff_t(j) * n;
    const double dj = d[size_t(j)];
    for (int i = 0; i < n; ++i) to[i] = from[i] * (d[size_t(i)] * dj);
    b[j] = p.b[j] * dj;
    lower[j] = p.lower[j] / dj;
    upper[j] = p.upper[j] / dj;
  }
}

}  // namespace tumble::lcp
