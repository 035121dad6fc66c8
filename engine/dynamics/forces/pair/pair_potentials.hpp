#pragma once
#include "engine/dynamics/forces/pair/pair_force.hpp"

#include <string_view>

namespace tumble {

/// Lennard and Jones (1931): U = 4 eps ((sigma/r)^12 - (sigma/r)^6). Least, -eps, at 2^(1/6) sigma.
struct LennardJonesDef {
  static constexpr std::string_view type_name = "lennard_jones";
  std::vector<ParticleSystemId> between;
  Varying epsilon = 1;  ///< [J]
  double sigma = 0.1;   ///< [m]
  PairEnd end;

  PairLaw law() const;
  double weight(const ParticleSystem&, size_t) const { return 1; }
  std::string fault() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.epsilon, {.name = "epsilon", .unit = "J", .min = 0, .doc = "depth of the well"});
    v.field(d.sigma, {.name = "sigma",
                      .unit = "m",
                      .min = 0,
                      .exclusive_min = true,
                      .doc = "distance at which the energy is zero"});
    PairEnd::parameters(v, d.end);
  }
};

/// Coulomb's law with softening: U = k q_a q_b / sqrt(r^2 + s^2), with the charges of the systems.
struct CoulombDef {
  static constexpr std::string_view type_name = "coulomb";
  std::vector<ParticleSystemId> between;
  Varying strength = 8.9875517923e9;  ///< k = 1 / (4 pi eps0) [N m2/C2]; CODATA 2018
  double softening = 0;               ///< s [m]
  PairEnd end;

  PairLaw law() const;
  double weight(const ParticleSystem& system, size_t) const { return system.charge; }
  std::string fault() const { return end.fault(); }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.strength, {.name = "strength",
                         .unit = "N m2/C2",
                         .min = 0,
                         .doc = "Coulomb's constant, that of the vacuum unless given"});
    v.field(d.softening, {.name = "softening",
                          .unit = "m",
                          .min = 0,
                          .doc = "length below which the force no longer grows"});
    PairEnd::parameters(v, d.end);
  }
};

/// Newton's gravity between particles with Plummer's softening: U = -G m_a m_b / sqrt(r^2 + s^2).
struct MutualGravityDef {
  static constexpr std::string_view type_name = "mutual_gravity";
  std::vector<ParticleSystemId> between;
  Varying strength = 6.6743e-11;  ///< G [N m2/kg2]; CODATA 2018
  double softening = 0;           ///< s [m]
  PairEnd end;

  PairLaw law() const;
  double weight(const ParticleSystem& system, size_t i) const { return system.mass[i]; }
  std::string fault() const { return end.fault(); }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.strength, {.name = "strength",
                         .unit = "N m2/kg2",
                         .min = 0,
                         .doc = "constant of gravity, nature's unless given"});
    v.field(d.softening, {.name = "softening",
                          .unit = "m",
                          .min = 0,
                          .doc = "length below which the pull no longer grows"});
    PairEnd::parameters(v, d.end);
  }
};

/// Morse (1929): U = D (exp(-2 a (r - r0)) - 2 exp(-a (r - r0))). Least, -D, at r0, where it is
/// like a spring of stiffness 2 D a^2.
struct MorseDef {
  static constexpr std::string_view type_name = "morse";
  std::vector<ParticleSystemId> between;
  Varying depth = 1;      ///< D [J]
  double distance = 0.1;  ///< r0 [m]
  double steepness = 30;  ///< a [1/m]
  PairEnd end;

  PairLaw law() const;
  double weight(const ParticleSystem&, size_t) const { return 1; }
  std::string fault() const { return end.fault(); }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.depth, {.name = "depth", .unit = "J", .min = 0, .doc = "of the well"});
    v.field(d.distance,
            {.name = "distance", .unit = "m", .min = 0, .doc = "at which the energy is least"});
    v.field(d.steepness, {.name = "steepness",
                          .unit = "1/m",
                          .min = 0,
                          .doc = "how narrow the well is: near its bottom the stiffness is 2 depth "
                                 "steepness^2"});
    PairEnd::parameters(v, d.end);
  }
};

/// An energy given by points, with a natural cubic spline through them. Nearer than the first point
/// it goes on in a straight line; behind the last nothing acts.
struct PairTableDef {
  static constexpr std::string_view type_name = "pair_table";
  std::vector<ParticleSystemId> between;
  std::vector<double> r;       ///< [m], ascending
  std::vector<double> energy;  ///< [J]
  Truncation truncation = Truncation::shifted;
  double smooth_from = 0;  ///< [m]

  PairLaw law() const;
  double weight(const ParticleSystem&, size_t) const { return 1; }
  std::string fault() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.r, {.name = "r",
                  .unit = "m",
                  .min = 0,
                  .required = true,
                  .doc = "distances, ascending; the last is the cut-off"});
    v.field(d.energy,
            {.name = "energy", .unit = "J", .required = true, .doc = "of a pair at these"});
    v.field(d.truncation, {.name = "truncation",
                           .doc = "how the energy ends at the last distance: truncated, shifted or "
                                  "smoothed"});
    v.field(d.smooth_from, {.name = "smooth_from",
                            .unit = "m",
                            .min = 0,
                            .doc = "smoothed: from here on the energy falls to zero"});
  }
};

}  // namespace tumble
