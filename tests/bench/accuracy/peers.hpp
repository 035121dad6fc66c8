#pragma once
#include "tests/support/accuracy/case_world.hpp"

#include <string>

/// The accuracy cases in other engines, with their default settings but for what a case asks for;
/// nothing sleeps.
namespace tumble::test {

/// Bullet, single precision, as Debian builds it.
CaseMaker bullet_maker();
/// ODE, double precision: `exact` with its direct solver (Dantzig's method), else QuickStep.
CaseMaker ode_maker(bool exact);
/// MuJoCo; `integrator` "Euler" or "RK4". It has no restitution.
CaseMaker mujoco_maker(std::string integrator);

}  // namespace tumble::test
