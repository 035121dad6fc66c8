#pragma once
#include "engine/dynamics/contact/element_gap.hpp"
#include "engine/math/jet.hpp"

namespace tumble {

/// An element in world axes about A's centre, on its way without acceleration.
struct MovingElement {
  ElementKind kind;
  Jet3 origin, direction;
  double radius;
  Mat3 semi_axes;  ///< as columns, as they are now
  Vec3 omega;

  /// How far the surface is round about a point or line; a circle's radius is its size.
  double rounding() const { return kind == ElementKind::circle ? 0 : radius; }
  /// A vector of the body.
  Jet3 carried(const Vec3& r) const {
    const Vec3 d = omega.cross(r);
    return Jet3::of(r, d, omega.cross(d));
  }
  /// A point of the body.
  Jet3 material(const Vec3& p) const { return origin + carried(p - origin.value()); }
};

/// Gap, normal from A to B and the point on A and on B.
struct GapJets {
  Jet gap;
  Jet3 normal, on_a, on_b;
  bool regular = true;

  static GapJets irregular() {
    GapJets g;
    g.regular = false;
    return g;
  }
};

}  // namespace tumble
