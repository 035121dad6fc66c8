#include "engine/dynamics/contact/element_gap.hpp"

#include "engine/math/jet.hpp"

#include <cmath>

namespace tumble {
namespace {

constexpr double degenerate = 1e-9;

/// An element in world axes about A's centre, on its way without acceleration.
struct MovingElement {
  ElementKind kind;
  Jet3 origin, direction;
  double radius;
};

Jet3 turning(const Vec3& r, const Vec3& omega) {
  const Vec3 d = omega.cross(r);
  return Jet3::of(r, d, omega.cross(d));
}

MovingElement moving(const SurfaceElement& e, const BodyMotion& m, const Vec3& about) {
  const Jet3 centre = Jet3::of(m.pose.x - about, m.v, Vec3::Zero());
  return {e.kind, centre + turning(m.pose.direction(e.origin), m.omega),
          turning(m.pose.direction(e.direction), m.omega), e.radius};
}

/// Gap, normal from A to B and the point on A and on B.
struct GapJets {
  Jet gap;
  Jet3 normal, on_a, on_b;
  bool regular = true;
};

GapJets between_points(const Jet3& p, double rp, const Jet3& q, double rq) {
  GapJets g;
  const Jet3 d = q - p;
  if (!(d.value().norm() > degenerate * (rp + rq) && d.value().norm() > 1e-12)) {
    g.regular = false;
    return g;
  }
  const Jet length = d.norm();
  g.normal = d / length;
  g.gap = length - rp - rq;
  g.on_a = p + g.normal * rp;
  g.on_b = q - g.normal * rq;
  return g;
}

GapJets point_plane(const MovingElement& p, const MovingElement& plane) {
  GapJets g;
  g.normal = -plane.direction;
  const Jet height = plane.direction.dot(p.origin - plane.origin);
  g.gap = height - p.radius;
  g.on_a = p.origin + g.normal * p.radius;
  g.on_b = p.origin + g.normal * height;
  return g;
}

GapJets point_line(const MovingElement& p, const MovingElement& line) {
  const Jet3 foot = line.origin + line.direction * line.direction.dot(p.origin - line.origin);
  return between_points(p.origin, p.radius, foot, line.radius);
}

GapJets line_line(const MovingElement& a, const MovingElement& b, const Vec3& towards_b) {
  GapJets g;
  const Jet3 across = a.direction.cross(b.direction), d = b.origin - a.origin;
  if (!(across.value().norm() > 1e-6)) {
    g.regular = false;
    return g;
  }
  const Jet square = across.dot(across);
  const Jet3 foot_a = a.origin + a.direction * (d.cross(b.direction).dot(across) / square);
  const Jet3 foot_b = b.origin + b.direction * (d.cross(a.direction).dot(across) / square);
  const Jet3 unit = across / sqrt(square);
  const Jet distance = unit.dot(d);
  const double side = unit.value().dot(towards_b) < 0 ? -1 : 1;
  g.normal = unit * Jet(side);
  g.gap = distance * Jet(side) - a.radius - b.radius;
  g.on_a = foot_a + g.normal * a.radius;
  g.on_b = foot_b - g.normal * b.radius;
  return g;
}

GapJets circle_plane(const MovingElement& c, const MovingElement& plane) {
  GapJets g;
  // The point of the rim furthest against the plane's normal.
  const Jet3 in_plane = plane.direction - c.direction * c.direction.dot(plane.direction);
  if (!(in_plane.value().norm() > degenerate)) {
    g.regular = false;
    return g;
  }
  const Jet3 rim = c.origin - in_plane / in_plane.norm() * c.radius;
  return point_plane({ElementKind::point, rim, c.direction, 0}, plane);
}

GapJets exchanged(GapJets g) {
  std::swap(g.on_a, g.on_b);
  g.normal = -g.normal;
  return g;
}

GapJets gap_of(const MovingElement& a, const MovingElement& b, const Vec3& towards_b) {
  using enum ElementKind;
  if (a.kind > b.kind) return exchanged(gap_of(b, a, -towards_b));
  if (a.kind == point && b.kind == point)
    return between_points(a.origin, a.radius, b.origin, b.radius);
  if (a.kind == point && b.kind == line) return point_line(a, b);
  if (a.kind == point && b.kind == plane) return point_plane(a, b);
  if (a.kind == line && b.kind == line) return line_line(a, b, towards_b);
  if (a.kind == plane && b.kind == circle) return exchanged(circle_plane(b, a));
  GapJets none;
  none.regular = false;
  return none;
}

}  // namespace

bool known_pair(ElementKind a, ElementKind b) {
  using enum ElementKind;
  if (a > b) std::swap(a, b);
  return (a == point && b != circle) || (a == line && b == line) || (a == plane && b == circle);
}

ElementGap element_gap(const SurfaceElement& a, const BodyMotion& motion_a, const SurfaceElement& b,
                       const BodyMotion& motion_b, const Vec3& towards_b) {
  const Vec3 about = motion_a.pose.x;
  const GapJets g = gap_of(moving(a, motion_a, about), moving(b, motion_b, about), towards_b);
  ElementGap out;
  out.regular = g.regular;
  if (!g.regular) return out;
  out.gap = g.gap.v;
  out.rate = g.gap.d;
  out.bias = g.gap.dd;
  out.normal = g.normal.value();
  out.x_world = about + 0.5 * (g.on_a.value() + g.on_b.value());
  // u = v_B + omega_B x (c - x_B) - ..., where c travels.
  const Vec3 travel = 0.5 * (g.on_a.first() + g.on_b.first());
  const Vec3 change =
      motion_b.omega.cross(travel - motion_b.v) - motion_a.omega.cross(travel - motion_a.v);
  out.tangential_bias = change - out.normal.dot(change) * out.normal;
  return out;
}

}  // namespace tumble
