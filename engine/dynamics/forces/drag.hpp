#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/forces/force_context.hpp"
#include "engine/math/varying.hpp"

#include <string_view>

namespace tumble {

/// Viscous drag on every dynamic body and particle: F = -c m v, torque -c I omega, with a rate c
/// in 1/s so that it means the same for every mass. Integrated exactly in the limit of no other
/// force: the impulse is that of v exp(-c h), so any rate is stable.
struct LinearDragDef {
  static constexpr std::string_view type_name = "linear_drag";
  Varying rate = 0.1;          ///< [1/s]
  Varying angular_rate = 0.1;  ///< [1/s]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.rate, {.name = "rate", .unit = "1/s", .min = 0, .doc = "decay rate of velocity"});
    v.field(
        d.angular_rate,
        {.name = "angular_rate", .unit = "1/s", .min = 0, .doc = "decay rate of angular velocity"});
  }
};

/// Quadratic drag of a fluid at rest, or moving as `wind`: F = -1/2 rho Cd A |u| u with u = v -
/// wind and A the area of the disc of the bounding radius (particles: their radius). The impulse is
/// that of du/dt = -k |u| u, so that it never overshoots. Torque -1/2 rho Cd r^5 |omega| omega.
struct QuadraticDragDef {
  static constexpr std::string_view type_name = "quadratic_drag";
  Varying fluid_density = 1.2;  ///< [kg/m3]
  double coefficient = 0.47;    ///< Cd [-]
  VaryingVec3 wind;             ///< velocity of the fluid [m/s]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.fluid_density,
            {.name = "fluid_density", .unit = "kg/m3", .min = 0, .doc = "density of the fluid"});
    v.field(d.coefficient, {.name = "coefficient", .min = 0, .doc = "drag coefficient"});
    v.field(d.wind, {.name = "wind", .unit = "m/s", .doc = "velocity of the fluid"});
  }
};

void apply(const LinearDragDef& def, ForceContext& context);
void apply(const QuadraticDragDef& def, ForceContext& context);

}  // namespace tumble
