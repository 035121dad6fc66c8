#pragma once
#include "engine/dynamics/forces/field.hpp"

#include <array>

namespace tumble {

/// A thin vortex ring, such as a smoke ring: fluid circulates about a circle of radius R, in a core
/// of radius a in which vorticity is even, and carries the ring along its axis with the speed
///     U = Gamma / (4 pi R) (ln(8 R / a) - 1/4)
/// (Kelvin 1867; Saffman, "Vortex Dynamics", 1992, section 10.2). The flow is the law of Biot and
/// Savart for the circle, with distances r^2 + delta^2 in place of r^2 (Rosenhead and Moore) and
/// delta = a exp(-3/4), which makes the flow on the circle itself that U; in closed form by
/// complete elliptic integrals. Divergence is zero. Several rings may follow each other; their
/// flows add up, but none moves another.
struct VortexRingDef {
  static constexpr std::string_view type_name = "vortex_ring";
  FieldTargets targets;
  Vec3 centre = Vec3::Zero();  ///< of the circle, at `start` [m]
  Vec3 axis = Vec3::UnitY();   ///< along which it flies, of any length but zero
  double radius = 1;           ///< R [m]
  double circulation = 10;     ///< Gamma at `start` [m2/s]
  double core_radius = 0.1;    ///< a [m]
  double start = 0;            ///< before it there is no flow [s]
  double decay = 0;            ///< rate at which the circulation dies away [1/s]
  int count = 1;               ///< of rings, at most most_rings
  double every = 1;            ///< from the start of one to that of the next [s]
  FlowGrip grip;

  static constexpr int most_rings = 16;
  struct Ring {
    Vec3 centre = Vec3::Zero();  ///< [m]
    double factor = 0;           ///< Gamma / 2 pi [m2/s]
  };
  struct Flow {
    Vec3 axis;
    double radius, softening2;           ///< [m], delta^2 [m2]
    std::array<Ring, most_rings> rings;  ///< those that have started
    int count;
    Vec3 operator()(const Vec3& x) const;
    Vec3 of_ring(const Ring& ring, const Vec3& x) const;
  };
  Flow at(double t) const;
  /// Says what is wrong beyond the ranges; empty for nothing.
  std::string fault() const;
  bool varies_in_time() const { return true; }
  /// U at `start` [m/s].
  double speed() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.centre, {.name = "centre", .unit = "m", .doc = "of the circle when it starts"});
    v.field(d.axis, {.name = "axis", .doc = "direction in which the ring flies"});
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .exclusive_min = true,
                       .doc = "of the circle about which the fluid turns"});
    v.field(d.circulation, {.name = "circulation",
                            .unit = "m2/s",
                            .doc = "line integral of the velocity once round the core"});
    v.field(d.core_radius,
            {.name = "core_radius",
             .unit = "m",
             .min = 0,
             .exclusive_min = true,
             .doc = "of the tube that turns like a solid; less than half the radius"});
    v.field(d.start, {.name = "start", .unit = "s", .min = 0, .doc = "when it is set off"});
    v.field(
        d.decay,
        {.name = "decay", .unit = "1/s", .min = 0, .doc = "rate at which circulation dies away"});
    v.field(d.count,
            {.name = "count", .min = 1, .max = most_rings, .doc = "rings, one after the other"});
    v.field(d.every, {.name = "every",
                      .unit = "s",
                      .min = 0,
                      .exclusive_min = true,
                      .doc = "from the start of one to that of the next"});
    FlowGrip::parameters(v, d.grip);
  }
};

/// Complete elliptic integrals of the first and second kind of the parameter m = k^2 in 0..1, by
/// the arithmetic-geometric mean (Abramowitz and Stegun 17.6), to rounding.
struct EllipticIntegrals {
  double k = 0, e = 0;
};
EllipticIntegrals elliptic_integrals(double m);

}  // namespace tumble
