#include "engine/math/lcp/system/cone_system.hpp"

#include "engine/math/lcp/cone.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::lcp {
namespace {

/// Sweep of a group: the axial unknown separately, then the lateral ones by projected gradient
/// steps with the length that their 2 x 2 block allows; w is updated.
void sweep_group(const ConeGroup& g, const Square& A, Triple& x, Triple& w) {
  const auto change = [&](size_t i, double to) {
    const double by = to - x[i];
    x[i] = to;
    for (size_t k = 0; k < 3; ++k) w[k] += by * A[3 * k + i];
  };
  const bool slides = g.mode == ConeMode::sliding;
  double slope = A[0];
  if (slides) slope -= g.slope * (A[1] * g.direction[0] + A[2] * g.direction[1]);
  if (slope > tolerances::no_stiffness) change(0, std::max(0.0, x[0] - w[0] / slope));
  const double mean = 0.5 * (A[4] + A[8]), half = 0.5 * (A[4] - A[8]);
  const double greatest = mean + std::sqrt(half * half + A[5] * A[5]);
  const double f = greatest > tolerances::no_stiffness ? 1 / greatest : 0;
  for (int k = 0; k < (slides ? 1 : 3); ++k) {
    const auto to = nearest_lateral(g, x[0], {x[1] - f * w[1], x[2] - f * w[2]});
    change(1, to[0]);
    change(2, to[1]);
  }
}

double sweep_single(const ConeUnit& unit, double a, double x, double w) {
  if (a > 0) return std::clamp(x - w / a, unit.lower, unit.upper);
  const double pushed = w < 0 ? unit.upper : unit.lower;
  return w != 0 && std::isfinite(pushed) ? pushed : x;
}

}  // namespace

std::vector<ConeUnit> cone_units(const LcpProblem& p, const std::vector<double>& d) {
  std::vector<ConeUnit> out;
  std::vector<char> grouped(d.size(), 0);
  for (const ConeGroup& g : p.groups) {
    const std::array<int, 3> row{g.axial, g.lateral[0], g.lateral[1]};
    out.push_back({3, row, &g, 0, std::numeric_limits<double>::infinity()});
    for (const int i : row) grouped[size_t(i)] = 1;
  }
  for (int i = 0; i < int(d.size()); ++i)
    if (!grouped[size_t(i)])
      out.push_back({1, {i}, nullptr, p.lower[i] / d[size_t(i)], p.upper[i] / d[size_t(i)]});
  return out;
}

VecX ConeSystem::in_own_units(VecX z) const {
  for (int i = 0; i < size(); ++i) z[i] *= units()[size_t(i)];
  return z;
}

VecX ConeSystem::in_scaled_units(VecX z) const {
  for (int i = 0; i < size(); ++i) z[i] /= units()[size_t(i)];
  return z;
}

VecX ConeSystem::rest() const {
  return in_scaled_units(nearest_to_zero(conditions()));
}

double ConeSystem::sweep(VecX& z) {
  double most = 0;
  for (size_t k = 0; k < parts().size(); ++k) {
    const ConeUnit& unit = parts()[k];
    Triple w = swept_slack(k), x = unit.of(z), by{};
    if (unit.group)
      sweep_group(*unit.group, own(k), x, w);
    else
      x[0] = sweep_single(unit, own(k)[0], x[0], w[0]);
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      by[r] = x[r] - z[unit.row[r]];
      z[unit.row[r]] = x[r];
      most = std::max(most, std::fabs(by[r]));
    }
    if (by != Triple{}) swept(k, by);
  }
  return most;
}

void BestPoint::consider(ConeSystem& system, const VecX& scaled) {
  VecX plain = system.in_own_units(scaled);
  const double now = system.residual(plain);
  if (!(now < residual)) return;
  residual = now;
  z = std::move(plain);
}

void grade_iterated(ConeSystem& system, const LcpOptions& options, LcpSolution& s) {
  s.report.status = LcpStatus::solved;
  system.grade(options.tolerance, s);
  if (!s.report.solved()) s.report.status = LcpStatus::max_iterations;
}

}  // namespace tumble::lcp
