#include "engine/math/lcp/least/range_basis.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/scaling.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <cmath>

namespace tumble::lcp {
namespace {

/// Removes from x its components along the first `count` columns of q, twice.
void remove_span(const MatX& q, int count, double* x) {
  const int n = int(q.rows());
  charge_work(size_t(n), 4 * size_t(count));
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < count; ++k) {
      const double* c = q.data() + std::ptrdiff_t(k) * n;
      add_scaled(x, -dot(c, x, n), c, n);
    }
}

/// Rows of the scaled matrix that are independent, in the order of their choice.
std::vector<int> independent_rows(const LcpProblem& p) {
  const ScaledProblem scaled(p);
  const int n = scaled.n;
  MatX rest(n, n), q(n, n);  // rows as columns
  std::vector<double> square(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) rest(j, i) = scaled.at(i, j);
    square[size_t(i)] = dot(rest.col(i).data(), rest.col(i).data(), n);
  }
  std::vector<int> chosen;
  for (int k = 0; k < n && !stop_requested(); ++k) {
    charge_work(size_t(n), 2 * size_t(n));
    int best = 0;
    for (int i = 1; i < n; ++i)
      if (square[size_t(i)] > square[size_t(best)] * (1 + tolerances::same_column)) best = i;
    double* c = q.data() + std::ptrdiff_t(k) * n;
    for (int j = 0; j < n; ++j) c[j] = rest(j, best);
    remove_span(q, k, c);
    const double length = std::sqrt(dot(c, c, n));
    if (!(length > tolerances::in_span)) break;
    for (int j = 0; j < n; ++j) c[j] /= length;
    chosen.push_back(best);
    square[size_t(best)] = -1;
    for (int i = 0; i < n; ++i) {
      if (square[size_t(i)] < 0) continue;
      double* x = rest.data() + std::ptrdiff_t(i) * n;
      add_scaled(x, -dot(c, x, n), c, n);
      square[size_t(i)] = dot(x, x, n);
    }
  }
  return chosen;
}

}  // namespace

MatX row_space(const LcpProblem& p) {
  const int n = p.size();
  const std::vector<int> rows = independent_rows(p);
  MatX q(n, Eigen::Index(rows.size()));
  for (int k = 0; k < int(rows.size()); ++k) {
    double* c = q.data() + std::ptrdiff_t(k) * n;
    double most = 0;
    for (int j = 0; j < n; ++j) {
      c[j] = p.A(rows[size_t(k)], j);
      most = std::max(most, std::fabs(c[j]));
    }
    for (int j = 0; j < n; ++j) c[j] /= most;
    remove_span(q, k, c);
    const double length = std::sqrt(dot(c, c, n));
    for (int j = 0; j < n; ++j) c[j] /= length;
  }
  return q;
}

}  // namespace tumble::lcp
