#pragma once
#include "engine/dynamics/forces/field.hpp"

namespace tumble {

/// Pulls towards a point: a = -k d exp(-|d|^2 / R^2), potential -k R^2/2 exp(-|d|^2 / R^2), with d
/// from the centre. Far inside the radius R, or without one (0), things swing harmonically with the
/// angular frequency sqrt(k), whatever their mass; then the potential is k |d|^2 / 2.
struct AttractorDef {
  static constexpr std::string_view type_name = "attractor";
  FieldTargets targets;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Varying strength = 10;       ///< k [1/s2]
  double radius = 0;           ///< R [m]

  Vec3 acceleration(const Vec3& x) const;
  double potential(const Vec3& x) const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre, {.name = "centre", .unit = "m", .doc = "what it pulls towards"});
    v.field(d.strength, {.name = "strength",
                         .unit = "1/s2",
                         .min = 0,
                         .doc = "acceleration per metre of distance: the square of the angular "
                                "frequency about the centre"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .doc = "distance by which the pull has weakened to 1/e of the harmonic "
                              "one; 0: it never does"});
  }
};

/// Pushes away from a point: a = k d exp(-|d|^2 / R^2), potential k R^2/2 exp(-|d|^2 / R^2), with d
/// from the centre.
struct RepulsorDef {
  static constexpr std::string_view type_name = "repulsor";
  FieldTargets targets;
  Vec3 centre = Vec3::Zero();  ///< [m]
  Varying strength = 10;       ///< k [1/s2]
  double radius = 1;           ///< R [m]

  Vec3 acceleration(const Vec3& x) const;
  double potential(const Vec3& x) const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre, {.name = "centre", .unit = "m", .doc = "what it pushes away from"});
    v.field(d.strength, {.name = "strength",
                         .unit = "1/s2",
                         .min = 0,
                         .doc = "acceleration per metre of distance near the centre"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .exclusive_min = true,
                       .doc = "range: the push is greatest at 0.71 of it"});
  }
};

}  // namespace tumble
