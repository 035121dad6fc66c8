#include "engine/math/ode/dense_lu.hpp"

#include <cmath>
#include <utility>

namespace tumble::ode {

bool DenseLu::factor(std::span<const double> rows, size_t n) {
  n_ = n;
  rows_.assign(rows.begin(), rows.end());
  swaps_.resize(n);
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; ++i) {
      if (std::abs(rows_[i * n + k]) > std::abs(rows_[pivot * n + k])) pivot = i;
    }
    swaps_[k] = pivot;
    const double diagonal = rows_[pivot * n + k];
    if (!std::isfinite(diagonal) || diagonal == 0) return false;
    if (pivot != k) {
      for (size_t j = 0; j < n; ++j) std::swap(rows_[k * n + j], rows_[pivot * n + j]);
    }
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = rows_[i * n + k] / diagonal;
      rows_[i * n + k] = factor;
      if (factor == 0) continue;
      for (size_t j = k + 1; j < n; ++j) rows_[i * n + j] -= factor * rows_[k * n + j];
    }
  }
  return true;
}

void DenseLu::solve(std::span<double> b) const {
  for (size_t k = 0; k < n_; ++k) {
    std::swap(b[k], b[swaps_[k]]);
  }
  for (size_t i = 1; i < n_; ++i) {
    for (size_t j = 0; j < i; ++j) b[i] -= rows_[i * n_ + j] * b[j];
  }
  for (size_t i = n_; i-- > 0;) {
    for (size_t j = i + 1; j < n_; ++j) b[i] -= rows_[i * n_ + j] * b[j];
    b[i] /= rows_[i * n_ + i];
  }
}

}  // namespace tumble::ode
