#include "engine/math/lcp/pivoting/pivot_state.hpp"

#include "engine/math/kernels.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {

PivotState::PivotState(const ScaledProblem& p)
    : problem(p),
      place(size_t(p.n)),
      clamped(size_t(p.n), 0),
      excused(size_t(p.n), 0),
      z(p.n),
      w(p.n),
      y_(size_t(p.n)) {
  factor.reset(p.n);
  for (int i = 0; i < p.n; ++i) {
    const bool low = std::isfinite(p.lower[i]), high = std::isfinite(p.upper[i]);
    place[size_t(i)] = low ? Place::lower : high ? Place::upper : Place::between;
    z[i] = low ? p.lower[i] : high ? p.upper[i] : 0;
  }
  renew_w();
}

bool PivotState::is_free(int i) const {
  return std::isinf(problem.lower[i]) && std::isinf(problem.upper[i]);
}

double PivotState::wrong(int i) const {
  if (clamped[size_t(i)] || excused[size_t(i)] || is_fixed(i)) return 0;
  switch (place[size_t(i)]) {
    case Place::lower:
      return std::max(0.0, -w[i]);
    case Place::upper:
      return std::max(0.0, w[i]);
    case Place::between:
      break;
  }
  return std::fabs(w[i]);
}

double PivotState::beyond(int i) const {
  return z[i] < problem.lower[i]   ? z[i] - problem.lower[i]
         : z[i] > problem.upper[i] ? z[i] - problem.upper[i]
                                   : 0.0;
}

double PivotState::reduce(int i, std::vector<double>& y) const {
  const double* column = problem.column(i);
  const auto& members = factor.members();
  for (size_t k = 0; k < members.size(); ++k) y[k] = column[members[k]];
  factor.forward(y.data());
  return factor.remainder(column[i], y.data());
}

bool PivotState::enter(int i, double least) {
  const double remainder = reduce(i, y_);
  if (!(remainder > least)) return false;
  enter(i, y_, remainder);
  return true;
}

void PivotState::enter(int i, const std::vector<double>& y, double remainder) {
  factor.append(i, y.data(), remainder);
  clamped[size_t(i)] = 1;
  place[size_t(i)] = Place::between;
  ++pivots;
}

void PivotState::leave(int i, Place to) {
  const auto& members = factor.members();
  leave_at(int(std::find(members.begin(), members.end(), i) - members.begin()), to);
}

void PivotState::leave_at(int position, Place to) {
  const int i = factor.members()[size_t(position)];
  factor.remove(position);
  clamped[size_t(i)] = 0;
  place[size_t(i)] = to;
  z[i] = to == Place::lower ? problem.lower[i] : problem.upper[i];
  ++pivots;
}

void PivotState::leave_many(const std::vector<int>& positions) {
  double updates = 0;
  const double m = factor.size();
  for (const int k : positions) updates += 2 * (m - k) * (m - k);
  const bool anew = updates > m * m * m / 6;
  std::vector<int> members = factor.members();
  for (size_t k = positions.size(); k-- > 0;) {
    const int i = members[size_t(positions[k])];
    const Place to =
        z[i] < problem.lower[i] || !std::isfinite(problem.upper[i]) ? Place::lower : Place::upper;
    if (!anew) {
      leave_at(positions[k], to);
      continue;
    }
    members[size_t(positions[k])] = -1;
    clamped[size_t(i)] = 0;
    place[size_t(i)] = to;
    z[i] = to == Place::lower ? problem.lower[i] : problem.upper[i];
    ++pivots;
  }
  if (!anew) return;
  std::erase(members, -1);
  factor_anew(members);
}

void PivotState::factor_anew(const std::vector<int>& members) {
  factor.reset(problem.n);
  for (const int i : members) {
    const double remainder = reduce(i, y_);
    factor.append(i, y_.data(), std::max(remainder, 1e-300));
  }
}

void PivotState::solve() {
  const auto& members = factor.members();
  for (const int i : members) z[i] = 0;
  renew_w();
  for (size_t k = 0; k < members.size(); ++k) y_[k] = -w[members[k]];
  factor.solve(y_.data());
  for (size_t k = 0; k < members.size(); ++k) z[members[k]] = y_[k];
  add_columns(w.data(), problem.A.data(), problem.n, members.data(), y_.data(), factor.size(),
              problem.n);
  for (size_t k = 0; k < members.size(); ++k) magnitude = std::max(magnitude, std::fabs(y_[k]));
}

void PivotState::refine() {
  renew_w();
  const auto& members = factor.members();
  for (size_t k = 0; k < members.size(); ++k) y_[k] = -w[members[k]];
  factor.solve(y_.data());
  for (size_t k = 0; k < members.size(); ++k) z[members[k]] += y_[k];
  add_columns(w.data(), problem.A.data(), problem.n, members.data(), y_.data(), factor.size(),
              problem.n);
}

void PivotState::renew_w() {
  w = problem.b;
  magnitude = 0;
  for (int j = 0; j < problem.n; ++j) {
    magnitude = std::max({magnitude, std::fabs(problem.b[j]), std::fabs(z[j])});
    if (z[j] != 0) add_scaled(w.data(), z[j], problem.column(j), problem.n);
  }
}

uint64_t PivotState::signature() const {
  uint64_t sum = 0;
  for (size_t i = 0; i < place.size(); ++i) {
    uint64_t x = (uint64_t(i) << 3 | uint64_t(place[i]) << 1 | uint64_t(clamped[i])) + 1;
    x *= 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    sum += x ^ (x >> 27);
  }
  return sum;
}

}  // namespace tumble::lcp
