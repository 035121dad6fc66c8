#include "engine/math/ode/semi_implicit_euler.hpp"

#include <cmath>

namespace tumble::ode {

StepReport SemiImplicitEuler::take(System& system, double t, double h, Start) {
  StepReport report;
  report.t = t;
  const size_t n = y0_.size();
  const std::span<const EntryKind> kinds = system.kinds();
  if (kinds.size() != n) {
    report.status = StepStatus::no_split;
    report.component = n;
    return report;
  }
  f0_.resize(n);
  f1_.resize(n);
  if (!evaluate(system, t, y0_, f0_, report)) return report;
  for (size_t i = 0; i < n; ++i) {
    y1_[i] = kinds[i] == EntryKind::momentum ? y0_[i] + h * f0_[i] : y0_[i];
  }
  ++report.evaluations;
  if (!system.position_derivative(t, y1_, f1_)) {
    report.status = StepStatus::refused;
    return report;
  }
  for (size_t i = 0; i < n; ++i) {
    if (kinds[i] == EntryKind::momentum) continue;
    if (!std::isfinite(f1_[i])) {
      report.status = StepStatus::non_finite;
      report.component = i;
      return report;
    }
    const double slope = kinds[i] == EntryKind::position ? f1_[i] : 0.5 * (f0_[i] + f1_[i]);
    y1_[i] = y0_[i] + h * slope;
  }
  system.normalise(y1_);
  report.advanced = h;
  return report;
}

}  // namespace tumble::ode
