#include "engine/math/lcp/pivoting/standard_form.hpp"

#include "engine/math/kernels.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {

bool all_slide(const LcpProblem& p) {
  return std::all_of(p.groups.begin(), p.groups.end(),
                     [](const ConeGroup& g) { return g.mode == ConeMode::sliding; });
}

std::vector<char> fold_sliding(const LcpProblem& problem, ScaledProblem& scaled) {
  std::vector<char> lateral(size_t(scaled.n), 0);
  for (const ConeGroup& g : problem.groups) {
    double* axial = scaled.A.data() + std::ptrdiff_t(g.axial) * scaled.n;
    for (size_t k = 0; k < 2; ++k) {
      add_scaled(axial, -g.slope * g.direction[k], scaled.column(g.lateral[k]), scaled.n);
      lateral[size_t(g.lateral[k])] = 1;
    }
  }
  return lateral;
}

void set_sliding(const LcpProblem& problem, VecX& z) {
  for (const ConeGroup& g : problem.groups)
    for (size_t k = 0; k < 2; ++k) z[g.lateral[k]] = -g.slope * g.direction[k] * z[g.axial];
}

StandardForm::StandardForm(const LcpProblem& problem)
    : problem_(problem), scaled_(problem), rest_(VecX::Zero(problem.size())) {
  const std::vector<char> dependent = fold_sliding(problem, scaled_);
  for (int i = 0; i < scaled_.n; ++i) {
    const bool low = std::isfinite(scaled_.lower[i]), high = std::isfinite(scaled_.upper[i]);
    if (dependent[size_t(i)]) continue;
    rest_[i] = low ? scaled_.lower[i] : high ? scaled_.upper[i] : 0;
    if (scaled_.lower[i] == scaled_.upper[i]) continue;
    if (low) parts_.push_back({Part::above_lower, i});
    if (low && high) parts_.push_back({Part::multiplier, i});
    if (!low && high) parts_.push_back({Part::below_upper, i});
    if (!low && !high) {
      parts_.push_back({Part::plus, i});
      parts_.push_back({Part::minus, i});
    }
  }
  size = int(parts_.size());
  VecX w = scaled_.b;
  for (int j = 0; j < scaled_.n; ++j)
    if (rest_[j] != 0) add_scaled(w.data(), rest_[j], scaled_.column(j), scaled_.n);
  M.resize(size_t(size) * size_t(size));
  for (int r = 0; r < size; ++r) {
    const Part& p = parts_[size_t(r)];
    const bool negative = p.kind == Part::below_upper || p.kind == Part::minus;
    q.push_back(p.kind == Part::multiplier ? scaled_.upper[p.unknown] - scaled_.lower[p.unknown]
                : negative                 ? -w[p.unknown]
                                           : w[p.unknown]);
    for (int c = 0; c < size; ++c) M[size_t(r) * size_t(size) + size_t(c)] = entry(r, c);
  }
}

double StandardForm::entry(int row, int column) const {
  const Part &r = parts_[size_t(row)], &c = parts_[size_t(column)];
  if (r.kind == Part::multiplier)
    return c.kind == Part::above_lower && c.unknown == r.unknown ? -1 : 0;
  if (c.kind == Part::multiplier)
    return r.kind == Part::above_lower && c.unknown == r.unknown ? 1 : 0;
  const auto sign = [](Part::Kind k) {
    return k == Part::below_upper || k == Part::minus ? -1 : 1;
  };
  return sign(r.kind) * sign(c.kind) * scaled_.at(r.unknown, c.unknown);
}

VecX StandardForm::back(const std::vector<double>& v, bool direction) const {
  VecX z = direction ? VecX::Zero(scaled_.n) : rest_;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const Part& p = parts_[k];
    if (p.kind == Part::multiplier) continue;
    z[p.unknown] += p.kind == Part::below_upper || p.kind == Part::minus ? -v[k] : v[k];
  }
  for (int i = 0; i < scaled_.n; ++i) z[i] *= scaled_.d[size_t(i)];
  set_sliding(problem_, z);
  return z;
}

}  // namespace tumble::lcp
