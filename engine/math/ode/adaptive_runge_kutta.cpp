#include "engine/math/ode/adaptive_runge_kutta.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/ode/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::ode {

namespace {

/// Largest ratio |v_i| / allowed_i.
double weighted(std::span<const double> v, std::span<const double> allowed) {
  double worst = 0;
  for (size_t i = 0; i < v.size(); ++i) worst = std::max(worst, std::abs(v[i]) / allowed[i]);
  return worst;
}

}  // namespace

StepReport AdaptiveRungeKutta::take(System& system, double t, double h, Start start) {
  StepReport report;
  const size_t n = y0_.size();
  const bool reuse = start == Start::continued && has_end_;
  has_end_ = false;
  stages_.resize(n);
  allowed_.resize(n);
  allowed_end_.resize(n);
  trial_.resize(n);
  report.t = t;
  if (!allow(system, settings.tolerance, y0_, allowed_, report)) return report;
  if (reuse) {
    std::copy_n(stages_.k(6).begin(), n, stages_.k(0).begin());
  } else if (!evaluate(system, t, y0_, stages_.k(0), report)) {
    return report;
  }

  const double whole = std::abs(h);
  double length = state_.h > 0 ? state_.h : first_step(system, t, h, report);
  double remembered = state_.h;
  for (;;) {
    // A remainder shorter than a hundredth of a step is taken along.
    const bool last = 1.01 * length >= whole;
    const double tried = last ? h : std::copysign(length, h);
    const bool defined = try_step(system, t, tried, report);
    size_t component = report.component;
    const double error =
        defined ? estimate(system, tried, component) : std::numeric_limits<double>::infinity();
    if (error <= 1) {
      double factor = StepControl::after_accepted(error, state_.error);
      if (report.rejected > 0) factor = std::min(factor, 1.0);
      const double next = std::abs(tried) * factor;
      // A step cut short by the end of the interval says little about the next.
      state_.h = last ? std::max(remembered, next) : next;
      state_.error = std::max(error, 1e-4);
      report.status = StepStatus::ok;
      report.error = error;
      report.advanced = tried;
      report.component = component;
      has_end_ = true;
      return report;
    }
    ++report.rejected;
    length = std::abs(tried) * (std::isfinite(error) ? StepControl::after_rejected(error) : 0.1);
    if (length < settings.min_step || t + std::copysign(length, h) == t) {
      if (defined) {
        report.status = StepStatus::step_too_small;
        report.t = t;
      }
      report.component = component;
      return report;
    }
    remembered = length;
  }
}

double AdaptiveRungeKutta::first_step(System& system, double t, double h, StepReport& report) {
  const double size = weighted(y0_, allowed_), slope = weighted(stages_.k(0), allowed_);
  double guess = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * size / slope;
  guess = std::min(guess, std::abs(h));
  const double signed_guess = std::copysign(guess, h);
  const std::span<const double> k0 = stages_.k(0);
  for (size_t i = 0; i < y0_.size(); ++i) trial_[i] = y0_[i] + signed_guess * k0[i];
  StepReport probe;
  const bool defined = evaluate(system, t + signed_guess, trial_, stages_.k(1), probe);
  report.evaluations += probe.evaluations;
  if (!defined) return guess;
  const std::span<const double> k1 = stages_.k(1);
  for (size_t i = 0; i < y0_.size(); ++i) trial_[i] = (k1[i] - k0[i]) / guess;
  const double steepest = std::max(slope, weighted(trial_, allowed_));
  const double by_curvature =
      steepest <= 1e-15 ? std::max(1e-6, guess * 1e-3) : det::pow(0.01 / steepest, 0.2);
  return std::min({100 * guess, by_curvature, std::abs(h)});
}

bool AdaptiveRungeKutta::try_step(System& system, double t, double h, StepReport& report) {
  const Tableau& tableau = dormand_prince_tableau();
  report.component = y0_.size();
  for (size_t s = 1; s < 6; ++s) {
    stages_.combine(y0_, h, tableau.a[s], s, trial_);
    if (!evaluate(system, t + tableau.c[s] * h, trial_, stages_.k(s), report)) return false;
  }
  stages_.combine(y0_, h, tableau.b, 6, y1_);
  report.component = first_non_finite(y1_);
  if (report.component < y1_.size()) {
    report.status = StepStatus::non_finite;
    return false;
  }
  system.normalise(y1_);
  return evaluate(system, t + h, y1_, stages_.k(6), report);
}

double AdaptiveRungeKutta::estimate(const System& system, double h, size_t& component) {
  const Tableau& tableau = dormand_prince_tableau();
  // What is allowed at either end: an entry may pass through zero.
  system.allowed_errors(settings.tolerance, y1_, allowed_end_);
  std::fill(trial_.begin(), trial_.end(), 0.0);
  for (size_t s = 0; s < tableau.stages; ++s) {
    const double w = tableau.error[s];
    const std::span<const double> slope = stages_.k(s);
    for (size_t i = 0; i < trial_.size(); ++i) trial_[i] += w * slope[i];
  }
  double worst = 0;
  component = 0;
  for (size_t i = 0; i < trial_.size(); ++i) {
    const double ratio = std::abs(h * trial_[i]) / std::max(allowed_[i], allowed_end_[i]);
    if (ratio <= worst) continue;
    worst = ratio;
    component = i;
    if (std::isnan(ratio)) break;  // nothing is worse
  }
  return worst;
}

void AdaptiveRungeKutta::interpolate(double theta, std::span<double> y) const {
  stages_.dense(y0_, h_, theta, y);
}

}  // namespace tumble::ode
