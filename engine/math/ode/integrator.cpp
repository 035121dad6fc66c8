#include "engine/math/ode/integrator.hpp"

#include "engine/math/ode/adaptive_runge_kutta.hpp"
#include "engine/math/ode/implicit_euler.hpp"
#include "engine/math/ode/runge_kutta.hpp"
#include "engine/math/ode/semi_implicit_euler.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::ode {

size_t first_non_finite(std::span<const double> values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return i;
  }
  return values.size();
}

bool Integrator::evaluate(System& system, double t, std::span<const double> y,
                          std::span<double> dydt, StepReport& report) {
  ++report.evaluations;
  report.t = t;
  if (!system.derivative(t, y, dydt)) {
    report.status = StepStatus::refused;
    return false;
  }
  report.component = first_non_finite(dydt);
  if (report.component == dydt.size()) return true;
  report.status = StepStatus::non_finite;
  return false;
}

bool Integrator::allow(const System& system, const Tolerance& tolerance, std::span<const double> y,
                       std::span<double> allowed, StepReport& report) {
  system.allowed_errors(tolerance, y, allowed);
  for (size_t i = 0; i < allowed.size(); ++i) {
    if (allowed[i] > 0) continue;
    report.status = StepStatus::bad_tolerance;
    report.component = i;
    return false;
  }
  return true;
}

StepReport Integrator::step(System& system, double t, double h, std::span<double> y, Start start) {
  StepReport report;
  report.t = t;
  const auto fail = [&](StepStatus status, size_t component) {
    report.status = status;
    report.component = component;
    return report;
  };
  if (!std::isfinite(t) || !std::isfinite(h) || y.size() != system.size()) {
    return fail(StepStatus::bad_input, y.size());
  }
  if (const size_t i = first_non_finite(y); i < y.size()) return fail(StepStatus::bad_state, i);
  if (start == Start::continued && !std::equal(y.begin(), y.end(), y1_.begin(), y1_.end())) {
    start = Start::fresh;
  }
  y0_.assign(y.begin(), y.end());
  y1_.resize(y.size());
  if (h == 0) {
    y1_ = y0_;
    t0_ = t;
    h_ = 0;
    return report;
  }
  report = take(system, t, h, start);
  if (!report.ok()) return report;
  if (const size_t i = first_non_finite(y1_); i < y.size()) {
    return fail(StepStatus::non_finite, i);
  }
  std::copy(y1_.begin(), y1_.end(), y.begin());
  t0_ = t;
  h_ = report.advanced;
  report.t = t + h_;
  report.steps = 1;
  return report;
}

StepReport Integrator::advance(System& system, double t, double h, std::span<double> y) {
  StepReport total = step(system, t, h, y);
  if (!total.ok() || total.advanced == h) return total;
  // What step() began with is gone after the second one.
  before_ = y0_;
  const auto fail = [&] {
    std::copy(before_.begin(), before_.end(), y.begin());
    total.advanced = 0;
    return total;
  };
  for (;;) {
    if (total.steps >= settings.max_steps) {
      total.status = StepStatus::too_many_steps;
      return fail();
    }
    const double left = h - total.advanced;
    const StepReport next = step(system, t + total.advanced, left, y, Start::continued);
    total.include(next);
    if (!next.ok()) return fail();
    if (next.advanced == left) {
      total.advanced = h;
      return total;
    }
  }
}

void Integrator::at(const System& system, double t, std::span<double> y) const {
  const double theta = h_ == 0 ? 0 : (t - t0_) / h_;
  if (theta == 0 || t == t0_) {
    std::copy(y0_.begin(), y0_.end(), y.begin());
  } else if (theta == 1 || t == t0_ + h_) {
    std::copy(y1_.begin(), y1_.end(), y.begin());
  } else {
    interpolate(theta, y);
    system.normalise(y);
  }
}

void Integrator::interpolate(double theta, std::span<double> y) const {
  for (size_t i = 0; i < y.size(); ++i) y[i] = y0_[i] + theta * (y1_[i] - y0_[i]);
}

const std::vector<IntegratorEntry>& all_integrators() {
  using Made = std::unique_ptr<Integrator>;
  static const std::vector<IntegratorEntry> list{
      {"explicit_euler", 1, "one derivative at the start; gains energy",
       []() -> Made { return std::make_unique<RungeKutta>("explicit_euler", euler_tableau()); }},
      {"semi_implicit_euler", 1, "momenta first, positions with the new momenta; symplectic",
       []() -> Made { return std::make_unique<SemiImplicitEuler>(); }},
      {"implicit_euler", 1, "derivative at the end by Newton's method; for stiff springs, damps",
       []() -> Made { return std::make_unique<ImplicitEuler>(); }},
      {"rk2", 2, "derivative at the middle of the step",
       []() -> Made { return std::make_unique<RungeKutta>("rk2", midpoint_tableau()); }},
      {"rk4", 4, "the classical four stages",
       []() -> Made { return std::make_unique<RungeKutta>("rk4", classical_tableau()); }},
      {"rk45", 5, "Dormand-Prince with steps chosen by the error",
       []() -> Made { return std::make_unique<AdaptiveRungeKutta>(); }},
  };
  return list;
}

}  // namespace tumble::ode
