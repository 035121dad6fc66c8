#pragma once
#include "engine/dynamics/contact/surface/element_gap.hpp"
#include "engine/math/jet.hpp"

namespace tumble {

/// An element in world axes relative to A's centre of mass. Number is Jet for a Taylor series in
/// time of a motion without acceleration, double for the present values only.
template <class Number>
struct MovingElement {
  using Place = Triple<Number>;

  ElementKind kind;
  Place origin, direction;
  double radius;
  Mat3 semi_axes;  ///< as columns, at the present time
  Vec3 omega;
  double taper = 0;

  /// Radius of the ball or cylinder about a point or line; a circle is sharp, its radius is its
  /// size.
  double rounding() const { return kind == ElementKind::circle ? 0 : radius; }
  /// A vector fixed in the body.
  Place carried(const Vec3& r) const {
    const Vec3 d = omega.cross(r);
    return triple_of<Number>(r, d, omega.cross(d));
  }
  /// A point fixed in the body.
  Place material(const Vec3& p) const { return origin + carried(p - value(origin)); }
};

/// Gap, normal from A to B, and the nearest point on A and on B.
template <class Number>
struct ElementMeeting {
  Number gap{};
  Triple<Number> normal{}, on_a{}, on_b{};
  bool regular = true;

  static ElementMeeting irregular() {
    ElementMeeting g;
    g.regular = false;
    return g;
  }
};

}  // namespace tumble
