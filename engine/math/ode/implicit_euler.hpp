#pragma once
#include "engine/math/lu.hpp"
#include "engine/math/ode/integrator.hpp"

namespace tumble::ode {

/// y1 = y0 + h f(t + h, y1), solved by Newton's method with the system's Jacobian or forward
/// differences. A Jacobian is reused while each correction is below 0.3 of the previous one; a
/// correction that does not lead to a smaller one is halved (natural monotonicity test: Deuflhard,
/// Newton Methods for Nonlinear Problems, 3.3). Entries of kind quadrature are not part of the
/// equations and follow from the solution.
class ImplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "implicit_euler"; }
  int order() const override { return 1; }
  bool bears_stiffness() const override { return true; }

 protected:
  StepReport take(System& system, double t, double h, Start start) override;

 private:
  /// Factors I - h df/dy over the unknowns, at y1_ with derivative f_.
  bool linearise(System& system, double t1, double h, StepReport& report);
  void difference_jacobian(System& system, double t1, double h, StepReport& report);
  /// The Newton correction at y with derivative f.
  void correction(double h, std::span<const double> y, std::span<const double> f,
                  std::span<double> out) const;
  /// Size of a correction over the allowed one; `component` gets the worst entry.
  double size(std::span<const double> correction, size_t* component = nullptr) const;
  /// Goes from y1_ along correction_ by 1, 1/2, 1/4 ... until the next correction is shorter.
  bool descend(System& system, double t1, double h, double& fraction, double& ratio,
               StepReport& report);
  void advance_quadratures(double h);

  std::vector<size_t> unknown_;  ///< entries that are in the equations
  std::vector<double> f_, trial_, f_trial_, jacobian_, matrix_, allowed_;
  std::vector<double> correction_, next_;  ///< by unknown
  LuFactor lu_;
};

}  // namespace tumble::ode
