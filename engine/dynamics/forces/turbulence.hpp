#pragma once
#include "engine/dynamics/forces/field.hpp"

#include <array>

namespace tumble {

/// Eddies: the curl of a noise (Bridson, Hourihan, Nordenstam 2007), so that their divergence is
/// zero. The noise is a gradient noise on a cubic lattice whose gradients turn with time (Perlin,
/// Neyret 2001); octave by octave eddies are half as large and, as Kolmogorov has it, slower by the
/// cube root of that. The same point, time and seed give the same bits.
struct TurbulenceDef {
  static constexpr std::string_view type_name = "turbulence";
  FieldTargets targets;
  Varying speed = 2;  ///< root mean square [m/s]
  double size = 1;    ///< of the largest eddies: spacing of the lattice [m]
  int octaves = 2;    ///< sizes of eddies
  double period = 4;  ///< after it every eddy has come and gone; 0: they stay for ever [s]
  uint64_t seed = 1;
  FlowGrip grip;

  static constexpr int phases = 64;
  struct Flow {
    int octaves;
    double size, scale;  ///< of the first octave [m], [m/s]
    uint64_t seed;
    std::array<double, phases> cosine, sine;  ///< of the angles that gradients have turned by
    Vec3 operator()(const Vec3& x) const;
  };
  Flow at(double t) const;
  bool varies_in_time() const { return period > 0; }

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.speed,
            {.name = "speed", .unit = "m/s", .min = 0, .doc = "root mean square of the velocity"});
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .exclusive_min = true,
                     .doc = "of the largest eddies"});
    v.field(d.octaves, {.name = "octaves",
                        .min = 1,
                        .max = 8,
                        .doc = "sizes of eddies, each half the one before"});
    v.field(d.period, {.name = "period",
                       .unit = "s",
                       .min = 0,
                       .doc = "time in which eddies come and go; 0: they stay"});
    v.field(d.seed, {.name = "seed", .doc = "another one: other eddies"});
    FlowGrip::parameters(v, d.grip);
  }
};

}  // namespace tumble
