#include "engine/math/lcp/pivoting/pivot_state.hpp"

#include "engine/math/kernels.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::lcp {

PivotState::PivotState(ScaledProblem scaled, const std::vector<ConeGroup>& cones)
    : problem(std::move(scaled)),
      n(problem.n),
      group_of(size_t(n), -1),
      role(size_t(n), Role::at_bound),
      place(size_t(n), Place::lower),
      excused(size_t(n), 0),
      z(VecX::Zero(n)),
      w(n),
      x_(size_t(n)),
      y_(size_t(n)) {
  for (const ConeGroup& g : cones) {
    for (const int i : {g.axial, g.lateral[0], g.lateral[1]})
      group_of[size_t(i)] = int(groups.size());
    groups.push_back({g});
  }
  if (groups.empty()) factor_.reset(n);
  for (int i = 0; i < n; ++i) {
    if (grouped(i)) continue;
    const bool low = std::isfinite(problem.lower[i]), high = std::isfinite(problem.upper[i]);
    place[size_t(i)] = low ? Place::lower : high ? Place::upper : Place::between;
    z[i] = low ? problem.lower[i] : high ? problem.upper[i] : 0;
    if (!low && !high) role[size_t(i)] = Role::resting;
  }
  renew_w();
}

double PivotState::outward(int i) const {
  const Group& g = group(i);
  const size_t k = g.cone.lateral[0] == i ? 0 : 1;
  if (g.prescribed() || (g.round() && k == 1)) return 0;
  return g.tie[k] > 0 ? w[i] : -w[i];
}

double PivotState::wrong(int i) const {
  const auto k = size_t(i);
  if (excused[k]) return 0;
  switch (role[k]) {
    case Role::clamped:
      return 0;
    case Role::resting:
      return std::fabs(w[i]);
    case Role::tied:
      return std::max(0.0, outward(i));
    case Role::at_bound:
      break;
  }
  if (is_lateral(i) || is_fixed(i)) return 0;
  return std::max(0.0, place[k] == Place::upper ? w[i] : -w[i]);
}

double PivotState::beyond(int i) const {
  return z[i] < problem.lower[i]   ? z[i] - problem.lower[i]
         : z[i] > problem.upper[i] ? z[i] - problem.upper[i]
                                   : 0.0;
}

/// Computes L^-1 times the column of i in the rows of the clamped unknowns, in y_; returns the
/// Schur complement of A_ii.
double PivotState::reduce(int i) {
  const double* column = problem.column(i);
  const auto& list = factor_.members();
  for (size_t k = 0; k < list.size(); ++k) y_[k] = column[list[k]];
  factor_.forward(y_.data());
  return factor_.remainder(column[i], y_.data());
}

/// Matrix entry in which the columns of tied laterals are added to that of their axial unknown.
double PivotState::tied_entry(int row, int column) const {
  double x = problem.at(row, column);
  if (!is_axial(column)) return x;
  const Group& g = group(column);
  for (size_t k = 0; k < 2; ++k)
    if (const int t = g.cone.lateral[k]; role[size_t(t)] == Role::tied)
      x += g.tie[k] * problem.at(row, t);
  return x;
}

bool PivotState::factor_tied() {
  clamped_.clear();
  for (int i = 0; i < n; ++i)
    if (is_clamped(i)) clamped_.push_back(i);
  const size_t m = clamped_.size();
  std::vector<double> a(m * m);
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i) a[j * m + i] = tied_entry(clamped_[i], clamped_[j]);
  return m == 0 || lu_.factor(a, int(m), tolerances::lost_clamped_pivot);
}

bool PivotState::direction(int l, double sign, VecX& dz, VecX& dw) {
  if (groups.empty()) {
    remainder_ = reduce(l);
    for (int k = 0; k < factor_.size(); ++k)
      x_[size_t(k)] = -sign * (y_[size_t(k)] / factor_.pivot(k));
    factor_.backward(x_.data());
  } else {
    if (!factor_tied()) return false;
    for (size_t k = 0; k < clamped_.size(); ++k) x_[k] = -sign * tied_entry(clamped_[k], l);
    if (!clamped_.empty()) lu_.solve(x_.data());
  }
  dz.setZero(n);
  const std::vector<int>& list = members();
  for (size_t k = 0; k < list.size(); ++k) dz[list[k]] = x_[k];
  dz[l] = sign;
  dw.resize(n);
  for (int i = 0; i < n; ++i) dw[i] = sign * problem.column(l)[i];
  for (const Group& g : groups)
    for (size_t k = 0; k < 2; ++k) {
      const int t = g.cone.lateral[k];
      if (role[size_t(t)] != Role::tied) continue;
      dz[t] = g.tie[k] * dz[g.cone.axial];
      if (dz[t] != 0) add_scaled(dw.data(), dz[t], problem.column(t), n);
    }
  add_columns(dw.data(), problem.A.data(), n, list.data(), x_.data(), int(list.size()), n);
  if (!groups.empty()) remainder_ = sign * dw[l];
  return true;
}

void PivotState::append(int i, double remainder) {
  if (groups.empty()) factor_.append(i, y_.data(), remainder);
  role[size_t(i)] = Role::clamped;
  place[size_t(i)] = Place::between;
  ++pivots;
}

void PivotState::enter_driven(int l) {
  if (!groups.empty() || remainder_ > 0) append(l, remainder_);
}

bool PivotState::enter(int i, double least) {
  const double remainder = groups.empty() ? reduce(i) : 1;
  if (!(remainder > least)) return false;
  append(i, remainder);
  return true;
}

void PivotState::leave(int i, Place to) {
  if (groups.empty() && is_clamped(i)) {
    const auto& list = factor_.members();
    factor_.remove(int(std::find(list.begin(), list.end(), i) - list.begin()));
  }
  role[size_t(i)] = Role::at_bound;
  place[size_t(i)] = to;
  z[i] = to == Place::lower ? problem.lower[i] : problem.upper[i];
  ++pivots;
}

void PivotState::leave_many(const std::vector<int>& positions) {
  double updates = 0;
  const double m = factor_.size();
  for (const int k : positions) updates += 2 * (m - k) * (m - k);
  const bool anew = updates > m * m * m / 6;
  std::vector<int> list = factor_.members();
  for (size_t k = positions.size(); k-- > 0;) {
    const int i = list[size_t(positions[k])];
    if (anew) {
      role[size_t(i)] = Role::at_bound;
      list[size_t(positions[k])] = -1;
    }
    const bool low = z[i] < problem.lower[i] || !std::isfinite(problem.upper[i]);
    leave(i, low ? Place::lower : Place::upper);
  }
  if (!anew) return;
  std::erase(list, -1);
  factor_anew(list);
}

void PivotState::factor_anew(const std::vector<int>& list) {
  factor_.reset(n);
  for (const int i : list) {
    const double remainder = reduce(i);
    factor_.append(i, y_.data(), std::max(remainder, tolerances::never_zero));
  }
}

void PivotState::solve() {
  const auto& list = factor_.members();
  for (const int i : list) z[i] = 0;
  refine();
  for (const int i : list) magnitude = std::max(magnitude, std::fabs(z[i]));
}

void PivotState::refine() {
  renew_w();
  const auto& list = factor_.members();
  for (size_t k = 0; k < list.size(); ++k) y_[k] = -w[list[k]];
  factor_.solve(y_.data());
  for (size_t k = 0; k < list.size(); ++k) z[list[k]] += y_[k];
  add_columns(w.data(), problem.A.data(), n, list.data(), y_.data(), factor_.size(), n);
}

void PivotState::renew_w() {
  w = problem.b;
  magnitude = 0;
  for (int j = 0; j < n; ++j) {
    magnitude = std::max({magnitude, std::fabs(problem.b[j]), std::fabs(z[j])});
    if (z[j] != 0) add_scaled(w.data(), z[j], problem.column(j), n);
  }
}

void PivotState::turn(Group& g, double x, double y) {
  const double length = std::sqrt(x * x + y * y);
  if (!(length > 0) || !g.round()) return;
  const double c = x / length, s = y / length;
  const int i = g.cone.lateral[0], j = g.cone.lateral[1];
  const auto rotate = [c, s](double& p, double& q) {
    const double first = c * p + s * q;
    q = c * q - s * p;
    p = first;
  };
  const auto at = [&](int row, int column) -> double& {
    return problem.A[size_t(column) * size_t(n) + size_t(row)];
  };
  for (int k = 0; k < n; ++k) rotate(at(k, i), at(k, j));
  for (int k = 0; k < n; ++k) rotate(at(i, k), at(j, k));
  rotate(problem.b[i], problem.b[j]);
  rotate(z[i], z[j]);
  rotate(w[i], w[j]);
  const double cosine = g.cosine * c - g.sine * s;
  g.sine = g.sine * c + g.cosine * s;
  g.cosine = cosine;
}

void PivotState::tie_along_z(Group& g) {
  turn(g, z[g.cone.lateral[0]], z[g.cone.lateral[1]]);
  g.tie = {g.cone.slope, 0};
  for (size_t k = 0; k < 2; ++k) {
    role[size_t(g.cone.lateral[k])] = Role::tied;
    z[g.cone.lateral[k]] = g.tie[k] * z[g.cone.axial];
  }
}

void PivotState::tie_against_w(Group& g) {
  const int i = g.cone.lateral[0], j = g.cone.lateral[1];
  if (g.cone.mode == ConeMode::sliding) {
    g.tie = {-g.cone.slope * g.cone.direction[0], -g.cone.slope * g.cone.direction[1]};
  } else if (g.round()) {
    turn(g, -w[i], -w[j]);
    g.tie = {g.cone.slope, 0};
  } else {
    g.tie = {w[i] > 0 ? -g.cone.slope : g.cone.slope, w[j] > 0 ? -g.cone.slope : g.cone.slope};
  }
  const bool still = g.round() && std::fabs(w[i]) + std::fabs(w[j]) <= tolerance();
  for (size_t k = 0; k < 2; ++k) {
    const int t = g.cone.lateral[k];
    const bool rests = still || (!g.prescribed() && !g.round() && std::fabs(w[t]) <= tolerance());
    role[size_t(t)] = rests ? Role::resting : Role::tied;
    if (!rests) z[t] = g.tie[k] * z[g.cone.axial];
  }
}

void PivotState::open(Group& g) {
  for (const int i : {g.cone.axial, g.cone.lateral[0], g.cone.lateral[1]}) {
    role[size_t(i)] = Role::at_bound;
    excused[size_t(i)] = 0;
    z[i] = 0;
  }
}

VecX PivotState::in_own_units(const VecX& from) const {
  VecX out = from;
  for (const Group& g : groups) {
    const double x = from[g.cone.lateral[0]], y = from[g.cone.lateral[1]];
    out[g.cone.lateral[0]] = g.cosine * x - g.sine * y;
    out[g.cone.lateral[1]] = g.sine * x + g.cosine * y;
  }
  for (int i = 0; i < n; ++i) out[i] *= problem.d[size_t(i)];
  return out;
}

uint64_t PivotState::signature() const {
  uint64_t sum = 0;
  for (size_t i = 0; i < role.size(); ++i) {
    uint64_t x = (uint64_t(i) << 4 | uint64_t(place[i]) << 2 | uint64_t(role[i])) + 1;
    x *= 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    sum += x ^ (x >> 27);
  }
  return sum;
}

}  // namespace tumble::lcp
