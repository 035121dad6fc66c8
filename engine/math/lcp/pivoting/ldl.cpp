#include "engine/math/lcp/pivoting/ldl.hpp"

#include "engine/math/kernels.hpp"

#include <cstring>

namespace tumble::lcp {

void LdlFactor::reset(int capacity) {
  members_.clear();
  members_.reserve(size_t(capacity));
  d_.clear();
  d_.reserve(size_t(capacity));
  stride_ = capacity + (capacity % 64 == 0 ? 4 : 0);  // columns that share no cache set
  l_.resize(size_t(stride_) * size_t(capacity));
  scratch_.resize(size_t(capacity));
}

void LdlFactor::forward(double* y) const {
  const int m = size();
  int j = 0;
  for (; j + 4 <= m; j += 4) {
    const double *c0 = column(j), *c1 = column(j + 1), *c2 = column(j + 2), *c3 = column(j + 3);
    const double y0 = y[j];
    const double y1 = y[j + 1] - c0[j + 1] * y0;
    const double y2 = y[j + 2] - c0[j + 2] * y0 - c1[j + 2] * y1;
    const double y3 = y[j + 3] - c0[j + 3] * y0 - c1[j + 3] * y1 - c2[j + 3] * y2;
    y[j + 1] = y1, y[j + 2] = y2, y[j + 3] = y3;
    const int from = j + 4;
    add_scaled4(y + from, -y0, c0 + from, -y1, c1 + from, -y2, c2 + from, -y3, c3 + from, m - from);
  }
  for (; j < m; ++j) add_scaled(y + j + 1, -y[j], column(j) + j + 1, m - j - 1);
}

void LdlFactor::backward(double* y) const {
  const int m = size();
  int j = m;
  for (; j % 4 != 0; --j) {
    const int k = j - 1;
    y[k] -= dot(column(k) + j, y + j, m - j);
  }
  for (; j > 0; j -= 4) {
    const int k = j - 4;
    const double *c0 = column(k), *c1 = column(k + 1), *c2 = column(k + 2);
    double s[4];
    dot4(c0 + j, stride_, y + j, m - j, s);
    const double y3 = y[k + 3] - s[3];
    const double y2 = y[k + 2] - s[2] - c2[k + 3] * y3;
    const double y1 = y[k + 1] - s[1] - c1[k + 3] * y3 - c1[k + 2] * y2;
    y[k] = y[k] - s[0] - c0[k + 3] * y3 - c0[k + 2] * y2 - c0[k + 1] * y1;
    y[k + 1] = y1, y[k + 2] = y2, y[k + 3] = y3;
  }
}

void LdlFactor::solve(double* y) const {
  forward(y);
  for (int i = 0; i < size(); ++i) y[i] /= d_[size_t(i)];
  backward(y);
}

double LdlFactor::remainder(double diagonal, const double* y) const {
  double sum = 0;
  for (int i = 0; i < size(); ++i) sum += y[i] * (y[i] / d_[size_t(i)]);
  return diagonal - sum;
}

void LdlFactor::append(int index, const double* y, double remainder) {
  const int m = size();
  for (int j = 0; j < m; ++j) column(j)[m] = y[j] / d_[size_t(j)];
  members_.push_back(index);
  d_.push_back(remainder);
}

void LdlFactor::remove(int position) {
  const int m = size(), k = position;
  for (int j = 0; j < k; ++j)
    std::memmove(column(j) + k, column(j) + k + 1, size_t(m - k - 1) * sizeof(double));
  // The contribution of column k to the rows below it is restored as a positive rank-one term.
  double* p = scratch_.data();
  std::memcpy(p + k + 1, column(k) + k + 1, size_t(m - k - 1) * sizeof(double));
  double factor = d_[size_t(k)];
  for (int j = k + 1; j < m; ++j) {
    const double pj = p[j], old = d_[size_t(j)], sum = old + factor * pj * pj;
    const double beta = factor * pj / sum;
    factor = factor * (old / sum);
    d_[size_t(j - 1)] = sum;
    const double* __restrict from = column(j);
    double* __restrict to = column(j - 1);
    double* __restrict rest = p;
    for (int i = j + 1; i < m; ++i) {
      rest[i] -= pj * from[i];
      to[i - 1] = from[i] + beta * rest[i];
    }
  }
  members_.erase(members_.begin() + k);
  d_.pop_back();
}

}  // namespace tumble::lcp
