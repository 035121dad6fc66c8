#include "engine/math/lu.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

bool LuFactor::factor(std::span<const double> a, int n, double least) {
  charge_work(size_t(n), size_t(n), size_t(n) / 3 + 4);
  a_.assign(a.begin(), a.end());
  n_ = n;
  swaps_.resize(size_t(n));
  double most = 0;
  for (const double x : a_) most = std::max(most, std::fabs(x));
  for (int k = 0; k < n; ++k) {
    if (stop_requested()) return false;
    double* c = column(k);
    // The columns to the left act on this one now: one pass over memory that stays in the cache.
    for (int j = 0; j < k; ++j)
      if (swaps_[size_t(j)] != j) std::swap(c[j], c[swaps_[size_t(j)]]);
    int j = 0;
    for (; j + 4 <= k; j += 4) {
      const double *l0 = column(j), *l1 = column(j + 1), *l2 = column(j + 2), *l3 = column(j + 3);
      const double u0 = c[j];
      const double u1 = c[j + 1] - l0[j + 1] * u0;
      const double u2 = c[j + 2] - l0[j + 2] * u0 - l1[j + 2] * u1;
      const double u3 = c[j + 3] - l0[j + 3] * u0 - l1[j + 3] * u1 - l2[j + 3] * u2;
      c[j + 1] = u1, c[j + 2] = u2, c[j + 3] = u3;
      const int from = j + 4;
      add_scaled4(c + from, -u0, l0 + from, -u1, l1 + from, -u2, l2 + from, -u3, l3 + from,
                  n - from);
    }
    for (; j < k; ++j) add_scaled(c + j + 1, -c[j], column(j) + j + 1, n - j - 1);
    int row = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(c[i]) > std::fabs(c[row])) row = i;
    swaps_[size_t(k)] = row;
    if (!(std::fabs(c[row]) > least * most)) return false;
    if (row != k)
      for (int i = 0; i <= k; ++i) std::swap(column(i)[k], column(i)[row]);
    const double inverse = c[k];
    for (int i = k + 1; i < n; ++i) c[i] /= inverse;
  }
  return true;
}

void LuFactor::solve(double* x) const {
  for (int k = 0; k < n_; ++k)
    if (swaps_[size_t(k)] != k) std::swap(x[k], x[swaps_[size_t(k)]]);
  for (int k = 0; k < n_; ++k) add_scaled(x + k + 1, -x[k], column(k) + k + 1, n_ - k - 1);
  for (int k = n_; k-- > 0;) {
    x[k] /= column(k)[k];
    add_scaled(x, -x[k], column(k), k);
  }
}

}  // namespace tumble
