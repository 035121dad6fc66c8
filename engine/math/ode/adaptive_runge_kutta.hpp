#pragma once
#include "engine/math/ode/runge_kutta.hpp"

namespace tumble::ode {

/// Dormand and Prince's 5(4) with adaptive steps: the estimated error of each entry is at most
/// System::allowed_errors(), where the worst entry decides. The solution of fifth order is used. A
/// trial with a derivative that is not finite or not available is repeated with a shorter step, so
/// that steps can approach a singularity but not cross it.
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
  /// Initial step with an error of about one percent of the allowed one (Hairer, Norsett, Wanner I,
  /// II.4, "Starting step size"), at most |h|; k(0) must be set.
  double first_step(System& system, double t, double h, StepReport& report);
  /// Computes stages 1 to 6 and y1_; false if a derivative fails.
  bool try_step(System& system, double t, double h, StepReport& report);
  /// Error of the trial in units of the allowed one; `component` gets the worst entry.
  double estimate(const System& system, double h, size_t& component);

  RungeKuttaStages stages_;
  AdaptiveState state_;
  std::vector<double> allowed_, allowed_end_, trial_;
  bool has_end_ = false;  ///< k(6) is the derivative at y1_
};

}  // namespace tumble::ode
