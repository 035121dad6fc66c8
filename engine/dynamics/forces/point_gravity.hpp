#pragma once
#include "engine/dynamics/forces/field.hpp"

namespace tumble {

/// Newton's gravity towards a point: a = -mu d / (|d|^2 + eps^2)^(3/2), potential
/// -mu / sqrt(|d|^2 + eps^2), with d from the centre and eps the softening (Plummer 1911).
struct PointGravityDef {
  static constexpr std::string_view type_name = "point_gravity";
  FieldTargets targets;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Varying mu = 1;              ///< G M [m3/s2]
  double softening = 0;        ///< eps [m]

  Vec3 acceleration(const Vec3& x) const;
  double potential(const Vec3& x) const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre, {.name = "centre", .unit = "m", .doc = "what it pulls towards"});
    v.field(d.mu, {.name = "mu",
                   .unit = "m3/s2",
                   .min = 0,
                   .doc = "gravitational constant times mass: orbits of radius r take 2 pi "
                          "sqrt(r^3 / mu)"});
    v.field(d.softening, {.name = "softening",
                          .unit = "m",
                          .min = 0,
                          .doc = "length below which the pull no longer grows"});
  }
};

}  // namespace tumble
