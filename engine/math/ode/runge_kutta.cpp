#include "engine/math/ode/runge_kutta.hpp"

#include <algorithm>

namespace tumble::ode {

void RungeKuttaStages::resize(size_t n) {
  n_ = n;
  k_.resize(std::max<size_t>(1, n * tableau_.stages));
}

void RungeKuttaStages::combine(std::span<const double> y0, double h,
                               std::span<const double> weights, size_t count,
                               std::span<double> out) const {
  std::fill(out.begin(), out.end(), 0.0);
  for (size_t s = 0; s < count; ++s) {
    const double w = weights[s];
    if (w == 0) continue;
    const std::span<const double> slope = k(s);
    for (size_t i = 0; i < n_; ++i) out[i] += w * slope[i];
  }
  for (size_t i = 0; i < n_; ++i) out[i] = y0[i] + h * out[i];
}

void RungeKuttaStages::dense(std::span<const double> y0, double h, double theta,
                             std::span<double> out) const {
  std::array<double, Tableau::max_stages> weights{};
  for (size_t s = 0; s < tableau_.stages; ++s) {
    const auto& d = tableau_.dense[s];
    weights[s] = theta * (d[0] + theta * (d[1] + theta * (d[2] + theta * d[3])));
  }
  combine(y0, h, weights, tableau_.stages, out);
}

StepReport RungeKutta::take(System& system, double t, double h, Start) {
  StepReport report;
  stages_.resize(y0_.size());
  if (!evaluate(system, t, y0_, stages_.k(0), report)) return report;
  for (size_t s = 1; s < tableau_.stages; ++s) {
    stages_.combine(y0_, h, tableau_.a[s], s, y1_);
    if (!evaluate(system, t + tableau_.c[s] * h, y1_, stages_.k(s), report)) return report;
  }
  stages_.combine(y0_, h, tableau_.b, tableau_.stages, y1_);
  system.normalise(y1_);
  report.advanced = h;
  return report;
}

void RungeKutta::interpolate(double theta, std::span<double> y) const {
  stages_.dense(y0_, h_, theta, y);
}

}  // namespace tumble::ode
