#include "engine/math/ode/implicit_euler.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::ode {

StepReport ImplicitEuler::take(System& system, double t, double h, Start) {
  StepReport report;
  const size_t n = y0_.size();
  const double t1 = t + h;
  const std::span<const EntryKind> kinds = system.kinds();
  unknown_.clear();
  for (size_t i = 0; i < n; ++i) {
    if (kinds.size() != n || kinds[i] != EntryKind::quadrature) unknown_.push_back(i);
  }
  for (auto* v : {&f_, &trial_, &f_trial_, &allowed_}) v->resize(n);
  correction_.resize(unknown_.size());
  next_.resize(unknown_.size());

  y1_ = y0_;
  report.t = t;
  if (!allow(system, settings.newton, y0_, allowed_, report)) return report;
  if (!evaluate(system, t1, y1_, f_, report)) return report;
  bool fresh = false;
  while (report.newton_iterations < settings.max_newton_iterations) {
    ++report.newton_iterations;
    if (!allow(system, settings.newton, y1_, allowed_, report)) break;
    if (!fresh) {
      if (!linearise(system, t1, h, report)) break;
      correction(h, y1_, f_, correction_);
    }
    double fraction = 1, ratio = 0;
    if (!descend(system, t1, h, fraction, ratio, report)) break;
    fresh = fraction == 1 && ratio < 0.3;
    // The last correction is small, and so is what it leaves: a part `ratio` of it.
    if (fraction == 1 && size(next_) * std::max(1.0, ratio / (1 - ratio)) <= 1) {
      for (size_t u = 0; u < unknown_.size(); ++u) y1_[unknown_[u]] += next_[u];
      advance_quadratures(h);
      system.normalise(y1_);
      report.status = StepStatus::ok;
      report.advanced = h;
      return report;
    }
    if (fresh) std::swap(correction_, next_);
  }
  if (report.status == StepStatus::ok) report.status = StepStatus::not_converged;
  if (report.status == StepStatus::not_converged) {
    size(correction_, &report.component);
    report.t = t1;
  }
  return report;
}

bool ImplicitEuler::linearise(System& system, double t1, double h, StepReport& report) {
  const size_t n = y0_.size(), m = unknown_.size();
  jacobian_.resize(n * n);
  if (!system.jacobian(t1, y1_, jacobian_)) difference_jacobian(system, t1, h, report);
  if (report.status != StepStatus::ok) return false;
  matrix_.resize(m * m);
  for (size_t c = 0; c < m; ++c) {
    for (size_t r = 0; r < m; ++r) {
      matrix_[c * m + r] = (r == c ? 1.0 : 0.0) - h * jacobian_[unknown_[r] * n + unknown_[c]];
    }
  }
  if (lu_.factor(matrix_, int(m), 0)) return true;
  report.status = StepStatus::not_converged;
  return false;
}

void ImplicitEuler::difference_jacobian(System& system, double t1, double h, StepReport& report) {
  const size_t n = y0_.size();
  trial_ = y1_;
  for (const size_t j : unknown_) {
    // Half of the digits of the entry, or of what it can become in this step.
    const double scale = std::max({std::abs(y1_[j]), std::abs(h * f_[j]), 1e-6});
    trial_[j] = y1_[j] + 1.5e-8 * scale;
    const double step = trial_[j] - y1_[j];
    if (!evaluate(system, t1, trial_, f_trial_, report)) return;
    for (size_t i = 0; i < n; ++i) jacobian_[i * n + j] = (f_trial_[i] - f_[i]) / step;
    trial_[j] = y1_[j];
  }
}

void ImplicitEuler::correction(double h, std::span<const double> y, std::span<const double> f,
                               std::span<double> out) const {
  for (size_t u = 0; u < unknown_.size(); ++u) {
    const size_t i = unknown_[u];
    out[u] = (y0_[i] - y[i]) + h * f[i];
  }
  lu_.solve(out.data());
}

double ImplicitEuler::size(std::span<const double> correction, size_t* component) const {
  double worst = 0;
  for (size_t u = 0; u < unknown_.size(); ++u) {
    const double ratio = std::abs(correction[u]) / allowed_[unknown_[u]];
    if (ratio <= worst) continue;
    worst = ratio;
    if (component) *component = unknown_[u];
    if (std::isnan(ratio)) break;  // nothing is worse
  }
  return worst;
}

bool ImplicitEuler::descend(System& system, double t1, double h, double& fraction, double& ratio,
                            StepReport& report) {
  const double length = size(correction_);
  StepReport probe;
  for (fraction = 1; fraction > 1e-4; fraction /= 2) {
    trial_ = y1_;
    for (size_t u = 0; u < unknown_.size(); ++u) {
      trial_[unknown_[u]] += fraction * correction_[u];
    }
    probe.status = StepStatus::ok;
    const bool defined = evaluate(system, t1, trial_, f_trial_, probe);
    if (!defined) continue;
    correction(h, trial_, f_trial_, next_);
    const double left = size(next_);
    ratio = length > 0 ? left / length : 0;
    // Rounding is all that is left where both corrections are within what is allowed.
    if (!(ratio <= 1 - fraction / 4) && !(left <= 1 && length <= 1)) continue;
    if (ratio >= 1) ratio = 0.5;
    std::swap(y1_, trial_);
    std::swap(f_, f_trial_);
    report.evaluations += probe.evaluations;
    return true;
  }
  report.evaluations += probe.evaluations;
  report.status = probe.status == StepStatus::ok ? StepStatus::not_converged : probe.status;
  report.component = probe.component;
  report.t = probe.t;
  return false;
}

void ImplicitEuler::advance_quadratures(double h) {
  size_t u = 0;
  for (size_t i = 0; i < y0_.size(); ++i) {
    if (u < unknown_.size() && unknown_[u] == i) {
      ++u;
    } else {
      y1_[i] = y0_[i] + h * f_[i];
    }
  }
}

}  // namespace tumble::ode
