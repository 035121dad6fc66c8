#pragma once
#include "engine/dynamics/forces/field.hpp"

namespace tumble {

/// Burgers' vortex (1948), an exact solution of the Navier-Stokes equations: around the axis
/// u = Gamma / (2 pi r) (1 - exp(-r^2 / a^2)), towards it -alpha r / 2, along it alpha z, with z
/// from the centre. Without strain alpha it is the vortex of Lamb and Oseen. Divergence is zero.
struct VortexDef {
  static constexpr std::string_view type_name = "vortex";
  FieldTargets targets;
  Vec3 centre = Vec3::Zero();  ///< a point of the axis [m]
  Vec3 axis = Vec3::UnitY();   ///< of any length but zero
  Varying circulation = 10;    ///< Gamma, by the right hand about the axis [m2/s]
  double core_radius = 0.5;    ///< a [m]
  Varying strain = 0;          ///< alpha [1/s]
  FlowGrip grip;

  struct Flow {
    Vec3 centre, axis;
    double factor, core2, strain;
    Vec3 operator()(const Vec3& x) const;
  };
  Flow at(double t) const;
  /// Says what is wrong beyond the ranges; empty for nothing.
  std::string fault() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre, {.name = "centre", .unit = "m", .doc = "a point of the axis"});
    v.field(d.axis, {.name = "axis", .doc = "direction of the axis"});
    v.field(d.circulation, {.name = "circulation",
                            .unit = "m2/s",
                            .doc = "2 pi r times the speed around the axis, far outside the core"});
    v.field(d.core_radius, {.name = "core_radius",
                            .unit = "m",
                            .min = 0,
                            .exclusive_min = true,
                            .doc = "inside it the fluid turns like a solid"});
    v.field(d.strain, {.name = "strain",
                       .unit = "1/s",
                       .doc = "inflow: towards the axis strain r / 2, along it strain z"});
    FlowGrip::parameters(v, d.grip);
  }
};

}  // namespace tumble
