#pragma once
#include "engine/math/ode/integrator.hpp"
#include "engine/math/ode/tableau.hpp"

namespace tumble::ode {

/// The stages of an explicit Runge-Kutta step, for fixed and for adaptive h.
class RungeKuttaStages {
 public:
  explicit RungeKuttaStages(const Tableau& tableau) : tableau_(tableau) {}

  void resize(size_t n);
  std::span<double> k(size_t stage) { return {&k_[stage * n_], n_}; }
  std::span<const double> k(size_t stage) const { return {&k_[stage * n_], n_}; }
  /// out = y0 + h sum_i weights_i k_i over the first `count` stages; a weight of zero is skipped.
  void combine(std::span<const double> y0, double h, std::span<const double> weights, size_t count,
               std::span<double> out) const;
  /// y0 + h times the dense output's polynomial at theta.
  void dense(std::span<const double> y0, double h, double theta, std::span<double> out) const;

 private:
  const Tableau& tableau_;
  size_t n_ = 0;
  std::vector<double> k_;
};

/// An explicit Runge-Kutta method with fixed steps.
class RungeKutta final : public Integrator {
 public:
  RungeKutta(std::string_view name, const Tableau& tableau)
      : name_(name), tableau_(tableau), stages_(tableau) {}
  std::string_view name() const override { return name_; }
  int order() const override { return tableau_.order; }

 protected:
  StepReport take(System& system, double t, double h, Start start) override;
  void interpolate(double theta, std::span<double> y) const override;

 private:
  std::string_view name_;
  const Tableau& tableau_;
  RungeKuttaStages stages_;
};

}  // namespace tumble::ode
