#include "engine/dynamics/contact/element_gap.hpp"

#include "engine/dynamics/contact/element_jets.hpp"
#include "engine/dynamics/contact/ellipsoid_gap.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double degenerate = 1e-9;
constexpr double parallel_tangents = 1e-6;  ///< [rad]

MovingElement moving(const SurfaceElement& e, const BodyMotion& m, const Vec3& about) {
  MovingElement out{e.kind, {}, {}, e.radius, Mat3::Zero(), m.omega};
  const Jet3 centre = Jet3::of(m.pose.x - about, m.v, Vec3::Zero());
  out.origin = centre + out.carried(m.pose.direction(e.origin));
  out.direction = out.carried(m.pose.direction(e.direction));
  if (e.kind == ElementKind::ellipsoid) out.semi_axes = m.pose.q.toRotationMatrix() * e.semi_axes;
  return out;
}

/// A point, line or circle at one of its points, which is at 0 of a parameter s.
struct CurvePoint {
  Vec3 at, along, bend;  ///< place, first and second derivative by s; the third is -spin * along
  double spin = 0;
};

CurvePoint nearest_of(const MovingElement& e, const Vec3& p) {
  const Vec3 o = e.origin.value(), n = e.direction.value();
  if (e.kind == ElementKind::point) return {o, Vec3::Zero(), Vec3::Zero()};
  if (e.kind == ElementKind::line) return {o + n.dot(p - o) * n, n, Vec3::Zero()};
  Vec3 out = p - o - n.dot(p - o) * n;
  out *= e.radius / std::max(out.norm(), 1e-300);
  return {o + out, n.cross(out), -out, 1};
}

/// The same as it moves.
struct MovingCurve {
  Jet3 base, along, bend;
  double spin;

  MovingCurve(const MovingElement& e, const CurvePoint& c)
      : base(e.material(c.at)), along(e.carried(c.along)), bend(e.carried(c.bend)), spin(c.spin) {}
  Jet3 place(const Jet& s) const { return base + along * s + bend * (s * s * Jet(0.5)); }
  Jet3 tangent(const Jet& s) const { return along * (Jet(1) - s * s * Jet(0.5 * spin)) + bend * s; }
};

/// Of half the square of the distance of two curves by their parameters: the second derivatives,
/// and where these have a saddle (far from the nearest points) those of the tangents alone.
struct Curvature {
  double aa, ab, bb;
  bool regular = true;

  Curvature(const CurvePoint& p, const CurvePoint& q) {
    const Vec3 d = q.at - p.at;
    const double pp = p.along.squaredNorm(), qq = q.along.squaredNorm();
    aa = pp - d.dot(p.bend), ab = -p.along.dot(q.along), bb = qq + d.dot(q.bend);
    if (!(pp > 0)) aa = 1;
    if (!(qq > 0)) bb = 1;
    constexpr double least = parallel_tangents * parallel_tangents;
    if (aa > 0 && bb > 0 && aa * bb - ab * ab > least * aa * bb) return;
    aa = pp > 0 ? pp : 1, bb = qq > 0 ? qq : 1;
    regular = aa * bb - ab * ab > least * aa * bb;
  }
  /// The change of the parameters that takes a slope away.
  template <class Number>
  std::pair<Number, Number> solve(const Number& fa, const Number& fb) const {
    const Number scale(1 / (aa * bb - ab * ab));
    return {(fb * Number(ab) - fa * Number(bb)) * scale,
            (fa * Number(ab) - fb * Number(aa)) * scale};
  }
};

/// Newton's method for the nearest points, from points near them; false where it does not converge.
bool approach_nearest(const MovingElement& a, const MovingElement& b, CurvePoint& p,
                      CurvePoint& q) {
  constexpr double longest = 0.5;  // step along a circle [rad]
  for (int n = 0; n < 60; ++n) {
    const Curvature c(p, q);
    if (!c.regular) return false;
    const Vec3 d = q.at - p.at;
    auto [s, u] = c.solve(-d.dot(p.along), d.dot(q.along));
    const double turn = std::max(std::fabs(s) * p.spin, std::fabs(u) * q.spin);
    if (turn > longest) s *= longest / turn, u *= longest / turn;
    p = nearest_of(a, p.at + s * p.along);
    q = nearest_of(b, q.at + u * q.along);
    const double size = p.at.norm() + q.at.norm() + d.norm();
    if (std::fabs(s) * p.along.norm() + std::fabs(u) * q.along.norm() <= 1e-13 * size) return true;
  }
  return false;
}

GapJets between_points(const Jet3& p, double rp, const Jet3& q, double rq) {
  const Jet3 d = q - p;
  if (!(d.value().norm() > degenerate * (rp + rq) && d.value().norm() > 1e-12))
    return GapJets::irregular();
  GapJets g;
  const Jet length = d.norm();
  g.normal = d / length;
  g.gap = length - Jet(rp + rq);
  g.on_a = p + g.normal * rp;
  g.on_b = q - g.normal * rq;
  return g;
}

/// Of sharp curves: along what is normal to both, which knows no side by itself but stays when they
/// pass through each other.
GapJets across_tangents(const Jet3& p, const Jet3& along_p, const Jet3& q, const Jet3& along_q,
                        const Vec3& towards_b) {
  const Jet3 across = along_p.cross(along_q);
  const double sine = across.value().norm();
  if (!(sine > parallel_tangents * along_p.value().norm() * along_q.value().norm()))
    return between_points(p, 0, q, 0);
  GapJets g;
  g.normal = across / across.norm();
  if (g.normal.value().dot(towards_b) < 0) g.normal = -g.normal;
  g.gap = g.normal.dot(q - p);
  g.on_a = p, g.on_b = q;
  return g;
}

/// Points, lines and circles: the nearest points are where the square of the distance is
/// stationary, a system of two equations solved by Newton's method; once more in Taylor arithmetic
/// with the matrix of the solution, each pass makes one more derivative exact (Griewank & Walther
/// 2008, 15.2).
GapJets curve_curve(const MovingElement& a, const MovingElement& b, const Vec3& towards_b) {
  const bool a_first = a.kind != ElementKind::line;
  // A rim's point of contact is the one furthest out along the normal; a point or a line follows.
  const auto start = [](const MovingElement& e, const MovingElement& other, const Vec3& out) {
    if (e.kind == ElementKind::circle && other.kind == ElementKind::point)
      return nearest_of(e, other.origin.value());
    return nearest_of(e, e.origin.value() + out);
  };
  CurvePoint p = start(a, b, towards_b), q = start(b, a, -towards_b);
  if (a_first) {
    if (b.kind != ElementKind::circle) q = nearest_of(b, p.at);
  } else {
    p = nearest_of(a, q.at);
  }
  if (!approach_nearest(a, b, p, q)) return GapJets::irregular();
  const MovingCurve on_a(a, p), on_b(b, q);
  const Curvature c(p, q);
  Jet s, u;
  for (int pass = 0; pass < 3; ++pass) {
    const Jet3 d = on_b.place(u) - on_a.place(s);
    const auto [ds, du] = c.solve(-d.dot(on_a.tangent(s)), d.dot(on_b.tangent(u)));
    s = s + ds, u = u + du;
  }
  const Jet3 pa = on_a.place(s), pb = on_b.place(u);
  const double ra = a.rounding(), rb = b.rounding();
  if (ra + rb > 0) return between_points(pa, ra, pb, rb);
  return across_tangents(pa, on_a.tangent(s), pb, on_b.tangent(u), towards_b);
}

GapJets point_plane(const Jet3& p, double radius, const MovingElement& plane) {
  GapJets g;
  g.normal = -plane.direction;
  const Jet height = plane.direction.dot(p - plane.origin);
  g.gap = height - Jet(radius);
  g.on_a = p + g.normal * radius;
  g.on_b = p + g.normal * height;
  return g;
}

GapJets curve_plane(const MovingElement& c, const MovingElement& plane) {
  if (c.kind == ElementKind::ellipsoid) return ellipsoid_plane(c, plane);
  if (c.kind == ElementKind::point) return point_plane(c.origin, c.radius, plane);
  if (c.kind != ElementKind::circle) return GapJets::irregular();
  // The point of the rim furthest against the plane's normal.
  const Jet3 in_plane = plane.direction - c.direction * c.direction.dot(plane.direction);
  if (!(in_plane.value().norm() > degenerate)) return GapJets::irregular();
  return point_plane(c.origin - in_plane / in_plane.norm() * c.radius, 0, plane);
}

GapJets exchanged(GapJets g) {
  std::swap(g.on_a, g.on_b);
  g.normal = -g.normal;
  return g;
}

GapJets gap_of(const MovingElement& a, const MovingElement& b, const Vec3& towards_b) {
  using enum ElementKind;
  if (a.kind == plane) return b.kind == plane ? GapJets::irregular() : exchanged(curve_plane(b, a));
  if (b.kind == plane) return curve_plane(a, b);
  if (a.kind == ellipsoid || b.kind == ellipsoid) return ellipsoid_curve(a, b, towards_b);
  return curve_curve(a, b, towards_b);
}

}  // namespace

bool known_pair(ElementKind a, ElementKind b) {
  using enum ElementKind;
  if (a > b) std::swap(a, b);
  return b != plane || a == point;
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
