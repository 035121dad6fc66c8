#include "engine/math/lcp/pivoting/cone_pivots.hpp"

#include "engine/math/kernels.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {

ConePivots::ConePivots(const LcpProblem& problem) : n(problem.size()) {
  ScaledProblem scaled(problem);
  A_ = std::move(scaled.A);
  d_ = std::move(scaled.d);
  b_ = std::move(scaled.b);
  lower = std::move(scaled.lower);
  upper = std::move(scaled.upper);
  group_of.assign(size_t(n), -1);
  role.assign(size_t(n), Role::at_bound);
  place.assign(size_t(n), Place::lower);
  excused.assign(size_t(n), 0);
  z = VecX::Zero(n);
  for (const ConeGroup& g : problem.groups) {
    for (const int i : {g.axial, g.lateral[0], g.lateral[1]})
      group_of[size_t(i)] = int(groups.size());
    groups.push_back({g});
  }
  for (int i = 0; i < n; ++i) {
    if (group_of[size_t(i)] >= 0) continue;
    const bool low = std::isfinite(lower[i]), high = std::isfinite(upper[i]);
    z[i] = low ? lower[i] : high ? upper[i] : 0;
    place[size_t(i)] = low ? Place::lower : high ? Place::upper : Place::between;
    if (!low && !high) role[size_t(i)] = Role::resting;
  }
  renew_w();
}

void ConePivots::turn(Group& g, double x, double y) {
  const double length = std::sqrt(x * x + y * y);
  if (!(length > 0) || !g.round()) return;
  const double c = x / length, s = y / length;
  const int i = g.cone.lateral[0], j = g.cone.lateral[1];
  const auto rotate = [c, s](double& p, double& q) {
    const double first = c * p + s * q;
    q = c * q - s * p;
    p = first;
  };
  double *ci = A_.data() + std::ptrdiff_t(i) * n, *cj = A_.data() + std::ptrdiff_t(j) * n;
  for (int k = 0; k < n; ++k) rotate(ci[k], cj[k]);
  for (int k = 0; k < n; ++k)
    rotate(A_[size_t(k) * size_t(n) + size_t(i)], A_[size_t(k) * size_t(n) + size_t(j)]);
  rotate(b_[i], b_[j]);
  rotate(z[i], z[j]);
  rotate(w[i], w[j]);
  const double cosine = g.cosine * c - g.sine * s;
  g.sine = g.sine * c + g.cosine * s;
  g.cosine = cosine;
}

void ConePivots::tie_along_z(Group& g) {
  turn(g, z[g.cone.lateral[0]], z[g.cone.lateral[1]]);
  g.tie = {g.cone.slope, 0};
  for (size_t k = 0; k < 2; ++k) {
    role[size_t(g.cone.lateral[k])] = Role::tied;
    z[g.cone.lateral[k]] = g.tie[k] * z[g.cone.axial];
  }
}

void ConePivots::tie_against_w(Group& g) {
  const int i = g.cone.lateral[0], j = g.cone.lateral[1];
  if (g.cone.mode == ConeMode::sliding) {
    g.tie = {-g.cone.slope * g.cone.direction[0], -g.cone.slope * g.cone.direction[1]};
  } else if (g.round()) {
    turn(g, -w[i], -w[j]);
    g.tie = {g.cone.slope, 0};
  } else {
    g.tie = {w[i] > 0 ? -g.cone.slope : g.cone.slope, w[j] > 0 ? -g.cone.slope : g.cone.slope};
  }
  const bool still =
      !g.prescribed() && g.round() && std::fabs(w[i]) + std::fabs(w[j]) <= tolerance();
  for (size_t k = 0; k < 2; ++k) {
    const int t = g.cone.lateral[k];
    const bool rests = still || (!g.prescribed() && !g.round() && std::fabs(w[t]) <= tolerance());
    role[size_t(t)] = rests ? Role::resting : Role::tied;
    if (!rests) z[t] = g.tie[k] * z[g.cone.axial];
  }
}

void ConePivots::open(Group& g) {
  for (const int i : {g.cone.axial, g.cone.lateral[0], g.cone.lateral[1]}) {
    role[size_t(i)] = Role::at_bound;
    excused[size_t(i)] = 0;
    z[i] = 0;
  }
}

double ConePivots::outward(int i) const {
  const Group& g = groups[size_t(group_of[size_t(i)])];
  const size_t k = g.cone.lateral[0] == i ? 0 : 1;
  if (g.prescribed() || (g.round() && k == 1)) return 0;
  return g.tie[k] > 0 ? w[i] : -w[i];
}

double ConePivots::wrong(int i) const {
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
  if (is_lateral(i) || lower[i] == upper[i]) return 0;
  return std::max(0.0, place[k] == Place::upper ? w[i] : -w[i]);
}

std::vector<int> ConePivots::clamped() const {
  std::vector<int> out;
  for (int i = 0; i < n; ++i)
    if (role[size_t(i)] == Role::clamped) out.push_back(i);
  return out;
}

double ConePivots::column_entry(int row, int column) const {
  double x = at(row, column);
  if (!is_axial(column)) return x;
  const Group& g = groups[size_t(group_of[size_t(column)])];
  for (size_t k = 0; k < 2; ++k)
    if (role[size_t(g.cone.lateral[k])] == Role::tied) x += g.tie[k] * at(row, g.cone.lateral[k]);
  return x;
}

bool ConePivots::factor(const std::vector<int>& c) {
  const size_t m = c.size();
  std::vector<double> a(m * m);
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i) a[j * m + i] = column_entry(c[i], c[j]);
  return m == 0 || lu_.factor(a, int(m), 1e-12);
}

/// Tied laterals move with their axial unknowns.
void ConePivots::follow(VecX& dz) const {
  for (const Group& g : groups)
    for (size_t k = 0; k < 2; ++k)
      if (role[size_t(g.cone.lateral[k])] == Role::tied)
        dz[g.cone.lateral[k]] = g.tie[k] * dz[g.cone.axial];
}

bool ConePivots::direction(int l, double sign, VecX& dz, VecX& dw) {
  const std::vector<int> c = clamped();
  if (!factor(c)) return false;
  std::vector<double> x(c.size());
  for (size_t i = 0; i < c.size(); ++i) x[i] = -sign * column_entry(c[i], l);
  if (!c.empty()) lu_.solve(x.data());
  dz = VecX::Zero(n);
  for (size_t i = 0; i < c.size(); ++i) dz[c[i]] = x[i];
  dz[l] = sign;
  follow(dz);
  dw = VecX::Zero(n);
  for (int j = 0; j < n; ++j)
    if (dz[j] != 0) add_scaled(dw.data(), dz[j], A_.data() + std::ptrdiff_t(j) * n, n);
  return true;
}

void ConePivots::renew_w() {
  w = b_;
  magnitude = 0;
  for (int j = 0; j < n; ++j) {
    magnitude = std::max({magnitude, std::fabs(b_[j]), std::fabs(z[j])});
    if (z[j] != 0) add_scaled(w.data(), z[j], A_.data() + std::ptrdiff_t(j) * n, n);
  }
}

VecX ConePivots::answer(bool ray, const VecX& from) const {
  VecX out = from;
  for (const Group& g : groups) {
    const double x = from[g.cone.lateral[0]], y = from[g.cone.lateral[1]];
    out[g.cone.lateral[0]] = g.cosine * x - g.sine * y;
    out[g.cone.lateral[1]] = g.sine * x + g.cosine * y;
  }
  for (int i = 0; i < n; ++i) {
    if (!ray && group_of[size_t(i)] < 0) out[i] = std::clamp(out[i], lower[i], upper[i]);
    out[i] *= d_[size_t(i)];
  }
  return out;
}

uint64_t ConePivots::signature() const {
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
