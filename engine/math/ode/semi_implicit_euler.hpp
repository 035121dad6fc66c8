#pragma once
#include "engine/math/ode/integrator.hpp"

namespace tumble::ode {

/// Momenta with the derivative at the start, positions with that of the new momenta:
///   p1 = p0 + h p'(q0, p0),  q1 = q0 + h q'(q0, p1)
/// (symplectic Euler; Hairer, Lubich, Wanner, I.1.2). Quadratures take the mean of the two
/// derivatives, whose work is exactly the kinetic energy that a constant mass gains from the force.
class SemiImplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "semi_implicit_euler"; }
  int order() const override { return 1; }

 protected:
  StepReport take(System& system, double t, double h, Start start) override;

 private:
  std::vector<double> f0_, f1_;
};

}  // namespace tumble::ode
