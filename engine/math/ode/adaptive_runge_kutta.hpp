#pragma once
#include "engine/math/ode/runge_kutta.hpp"

namespace tumble::ode {

/// Dormand and Prince's 5(4) with steps as long as the tolerance allows: of an error estimated for
/// each entry no more than System::allowed_errors(), the greatest of all entries counting. The
/// solution of fifth order is taken. A trial that meets a non-finite derivative, or none, is
/// repeated with less, so that a step can creep up to a singularity but not across.
class AdaptiveRungeKutta final : public Integrator {
 public:
  AdaptiveRungeKutta() : stages_(dormand_prince_tableau()) {}
  std::string_view name() const override { return "rk45"; }
  int order() const override { return 5; }
  bool adaptive() const override { return true; }

  AdaptiveState adaptive_state() const override { return state_; }
  void set_adaptive_state(const AdaptiveState& state) override { state_ = state; }

 protected:
  StepReport take(System& system, double t, double h, Start start) override;
  void interpolate(double theta, std::span<double> y) const override;

 private:
  /// A step of about one percent of the allowed error (Hairer, Norsett, Wanner I, II.4, "Starting
  /// step size"), at most |h|; k(0) is known.
  double first_step(System& system, double t, double h, StepReport& report);
  /// Stages 1 to 6 and y1_; false if a derivative fails.
  bool try_step(System& system, double t, double h, StepReport& report);
  /// Error of the trial in units of the allowed one; `component` gets the worst entry.
  double estimate(const System& system, double h, size_t& component);

  RungeKuttaStages stages_;
  AdaptiveState state_;
  std::vector<double> allowed_, allowed_end_, trial_;
  bool has_end_ = false;  ///< k(6) is the derivative at y1_
};

}  // namespace tumble::ode
