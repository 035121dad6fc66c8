#include "engine/dynamics/contact/surface/element_gap.hpp"

#include "engine/dynamics/contact/surface/cone_gap.hpp"
#include "engine/dynamics/contact/surface/element_jets.hpp"
#include "engine/dynamics/contact/surface/ellipsoid_gap.hpp"
#include "engine/dynamics/contact/surface/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

template <class Number>
MovingElement<Number> moving(const SurfaceElement& e, const BodyMotion& m, const Vec3& about) {
  MovingElement<Number> out{e.kind, {}, {}, e.radius, Mat3::Zero(), m.omega, e.taper};
  out.origin = triple_of<Number>(m.pose.x - about, m.v, Vec3::Zero()) +
               out.carried(m.pose.direction(e.origin));
  out.direction = out.carried(m.pose.direction(e.direction));
  if (e.kind == ElementKind::ellipsoid) out.semi_axes = m.pose.q.toRotationMatrix() * e.semi_axes;
  return out;
}

/// A point of a point, line or circle element, and its derivatives by a parameter s that is 0
/// there.
struct CurvePoint {
  Vec3 at, along, bend;  ///< position, first and second derivative by s; the third is -spin * along
  double spin = 0;
};

template <class Number>
CurvePoint nearest_of(const MovingElement<Number>& e, const Vec3& p) {
  const Vec3 o = value(e.origin), n = value(e.direction);
  if (e.kind == ElementKind::point) return {o, Vec3::Zero(), Vec3::Zero()};
  if (e.kind == ElementKind::line) return {o + n.dot(p - o) * n, n, Vec3::Zero()};
  Vec3 out = p - o - n.dot(p - o) * n;
  out *= e.radius / std::max(out.norm(), tolerances::never_zero);
  return {o + out, n.cross(out), -out, 1};
}

/// The same curve as a Taylor series in time.
template <class Number>
struct MovingCurve {
  using Place = Triple<Number>;
  Place base, along, bend;
  double spin;

  MovingCurve(const MovingElement<Number>& e, const CurvePoint& c)
      : base(e.material(c.at)), along(e.carried(c.along)), bend(e.carried(c.bend)), spin(c.spin) {}
  Place place(const Number& s) const { return base + along * s + bend * (s * s * Number(0.5)); }
  Place tangent(const Number& s) const {
    return along * (Number(1) - s * s * Number(0.5 * spin)) + bend * s;
  }
};

/// Second derivatives of half the squared distance of two curves by their parameters; where they
/// are indefinite (far from the nearest points), the part of the tangents alone (Gauss-Newton).
struct Curvature {
  double aa, ab, bb;
  bool regular = true;

  Curvature(const CurvePoint& p, const CurvePoint& q) {
    const Vec3 d = q.at - p.at;
    const double pp = p.along.squaredNorm(), qq = q.along.squaredNorm();
    aa = pp - d.dot(p.bend), ab = -p.along.dot(q.along), bb = qq + d.dot(q.bend);
    if (!(pp > 0)) aa = 1;
    if (!(qq > 0)) bb = 1;
    constexpr double least = tolerances::parallel_lines * tolerances::parallel_lines;
    if (aa > 0 && bb > 0 && aa * bb - ab * ab > least * aa * bb) return;
    aa = pp > 0 ? pp : 1, bb = qq > 0 ? qq : 1;
    regular = aa * bb - ab * ab > least * aa * bb;
  }
  /// The Newton step of the parameters for a gradient (fa, fb).
  template <class Number>
  std::pair<Number, Number> solve(const Number& fa, const Number& fb) const {
    const Number scale(1 / (aa * bb - ab * ab));
    return {(fb * Number(ab) - fa * Number(bb)) * scale,
            (fa * Number(ab) - fb * Number(aa)) * scale};
  }
};

/// Newton's method for the nearest points, from points near them; false where it does not converge.
template <class Number>
bool approach_nearest(const MovingElement<Number>& a, const MovingElement<Number>& b, CurvePoint& p,
                      CurvePoint& q) {
  constexpr double longest = tolerances::newton_longest_step;
  for (int n = 0; n < tolerances::newton_iterations; ++n) {
    const Curvature c(p, q);
    if (!c.regular) return false;
    const Vec3 d = q.at - p.at;
    auto [s, u] = c.solve(-d.dot(p.along), d.dot(q.along));
    const double turn = std::max(std::fabs(s) * p.spin, std::fabs(u) * q.spin);
    if (turn > longest) s *= longest / turn, u *= longest / turn;
    p = nearest_of(a, p.at + s * p.along);
    q = nearest_of(b, q.at + u * q.along);
    const double size = p.at.norm() + q.at.norm() + d.norm();
    if (std::fabs(s) * p.along.norm() + std::fabs(u) * q.along.norm() <=
        tolerances::newton_converged * size)
      return true;
  }
  return false;
}

template <class Number>
ElementMeeting<Number> between_points(const Triple<Number>& p, double rp, const Triple<Number>& q,
                                      double rq) {
  const Triple<Number> d = q - p;
  if (!(value(d).norm() > tolerances::no_direction * (rp + rq) &&
        value(d).norm() > tolerances::coincident_points))
    return ElementMeeting<Number>::irregular();
  ElementMeeting<Number> g;
  const Number length = d.norm();
  g.normal = d / length;
  g.gap = length - Number(rp + rq);
  g.on_a = p + g.normal * rp;
  g.on_b = q - g.normal * rq;
  return g;
}

/// Meeting of sharp curves, with the normal perpendicular to both tangents: its sign is open, but
/// it stays defined when the curves pass through each other.
template <class Number>
ElementMeeting<Number> across_tangents(const Triple<Number>& p, const Triple<Number>& along_p,
                                       const Triple<Number>& q, const Triple<Number>& along_q,
                                       const Vec3& towards_b) {
  const Triple<Number> across = along_p.cross(along_q);
  const double sine = value(across).norm();
  if (!(sine > tolerances::parallel_lines * value(along_p).norm() * value(along_q).norm()))
    return between_points(p, 0, q, 0);
  ElementMeeting<Number> g;
  g.normal = across / across.norm();
  if (value(g.normal).dot(towards_b) < 0) g.normal = -g.normal;
  g.gap = g.normal.dot(q - p);
  g.on_a = p, g.on_b = q;
  return g;
}

/// Points, lines and circles: the nearest points are where the squared distance is stationary, a
/// system of two equations solved by Newton's method, then repeated in Taylor arithmetic with the
/// matrix at the solution, where each pass makes one more derivative exact (Griewank & Walther
/// 2008, 15.2).
template <class Number>
ElementMeeting<Number> curve_curve(const MovingElement<Number>& a, const MovingElement<Number>& b,
                                   const Vec3& towards_b) {
  const bool a_first = a.kind != ElementKind::line;
  // The search starts at the point of a rim that is furthest out along the normal, and at the point
  // of the other element nearest to that.
  const auto start = [](const auto& e, const auto& other, const Vec3& out) {
    if (e.kind == ElementKind::circle && other.kind == ElementKind::point)
      return nearest_of(e, value(other.origin));
    return nearest_of(e, value(e.origin) + out);
  };
  CurvePoint p = start(a, b, towards_b), q = start(b, a, -towards_b);
  if (a_first) {
    if (b.kind != ElementKind::circle) q = nearest_of(b, p.at);
  } else {
    p = nearest_of(a, q.at);
  }
  if (!approach_nearest(a, b, p, q)) return ElementMeeting<Number>::irregular();
  const MovingCurve<Number> on_a(a, p), on_b(b, q);
  const Curvature c(p, q);
  Number s{}, u{};
  for (int pass = 0; pass < 3; ++pass) {
    const Triple<Number> d = on_b.place(u) - on_a.place(s);
    const auto [ds, du] = c.solve(-d.dot(on_a.tangent(s)), d.dot(on_b.tangent(u)));
    s = s + ds, u = u + du;
  }
  const Triple<Number> pa = on_a.place(s), pb = on_b.place(u);
  const double ra = a.rounding(), rb = b.rounding();
  if (ra + rb > 0) return between_points(pa, ra, pb, rb);
  return across_tangents(pa, on_a.tangent(s), pb, on_b.tangent(u), towards_b);
}

template <class Number>
ElementMeeting<Number> point_plane(const Triple<Number>& p, double radius,
                                   const MovingElement<Number>& plane) {
  ElementMeeting<Number> g;
  g.normal = -plane.direction;
  const Number height = plane.direction.dot(p - plane.origin);
  g.gap = height - Number(radius);
  g.on_a = p + g.normal * radius;
  g.on_b = p + g.normal * height;
  return g;
}

template <class Number>
ElementMeeting<Number> curve_plane(const MovingElement<Number>& c,
                                   const MovingElement<Number>& plane) {
  if (c.kind == ElementKind::ellipsoid) return ellipsoid_plane(c, plane);
  if (c.kind == ElementKind::point) return point_plane(c.origin, c.radius, plane);
  if (c.kind != ElementKind::circle) return ElementMeeting<Number>::irregular();
  // The point of the rim furthest against the plane's normal touches.
  const Triple<Number> in_plane = plane.direction - c.direction * c.direction.dot(plane.direction);
  if (!(value(in_plane).norm() > tolerances::no_direction))
    return ElementMeeting<Number>::irregular();
  return point_plane(c.origin - in_plane / in_plane.norm() * c.radius, 0, plane);
}

template <class Number>
ElementMeeting<Number> exchanged(ElementMeeting<Number> g) {
  std::swap(g.on_a, g.on_b);
  g.normal = -g.normal;
  return g;
}

template <class Number>
ElementMeeting<Number> gap_of(const MovingElement<Number>& a, const MovingElement<Number>& b,
                              const Vec3& towards_b) {
  using enum ElementKind;
  if (a.kind == plane)
    return b.kind == plane ? ElementMeeting<Number>::irregular() : exchanged(curve_plane(b, a));
  if (b.kind == plane) return curve_plane(a, b);
  if (a.kind == cone || b.kind == cone) return cone_gap(a, b, towards_b);
  if (a.kind == ellipsoid || b.kind == ellipsoid) return ellipsoid_curve(a, b, towards_b);
  return curve_curve(a, b, towards_b);
}

/// All positions are relative to A's centre of mass.
template <class Number>
ElementMeeting<Number> meeting(const SurfaceElement& a, const BodyMotion& motion_a,
                               const SurfaceElement& b, const BodyMotion& motion_b,
                               const Vec3& towards_b) {
  const Vec3 about = motion_a.pose.x;
  return gap_of(moving<Number>(a, motion_a, about), moving<Number>(b, motion_b, about), towards_b);
}

template <class Number>
ElementPlace place_of(const ElementMeeting<Number>& g, const Vec3& about) {
  ElementPlace out;
  out.regular = g.regular;
  if (!g.regular) return out;
  out.gap = value(g.gap);
  out.normal = value(g.normal);
  out.x_world = about + 0.5 * (value(g.on_a) + value(g.on_b));
  return out;
}

}  // namespace

bool known_pair(ElementKind a, ElementKind b) {
  using enum ElementKind;
  if (b == plane) std::swap(a, b);
  return a != plane || b == point || b == circle || b == ellipsoid;
}

ElementPlace element_place(const SurfaceElement& a, const BodyMotion& motion_a,
                           const SurfaceElement& b, const BodyMotion& motion_b,
                           const Vec3& towards_b) {
  return place_of(meeting<double>(a, motion_a, b, motion_b, towards_b), motion_a.pose.x);
}

ElementGap element_gap(const SurfaceElement& a, const BodyMotion& motion_a, const SurfaceElement& b,
                       const BodyMotion& motion_b, const Vec3& towards_b) {
  const auto g = meeting<Jet>(a, motion_a, b, motion_b, towards_b);
  ElementGap out{place_of(g, motion_a.pose.x)};
  if (!g.regular) return out;
  out.rate = g.gap.d;
  out.bias = g.gap.dd;
  // u = v_B + omega_B x (c - x_B) - v_A - ..., where the contact point c travels.
  const Vec3 travel = 0.5 * (first(g.on_a) + first(g.on_b));
  const Vec3 change =
      motion_b.omega.cross(travel - motion_b.v) - motion_a.omega.cross(travel - motion_a.v);
  out.tangential_bias = change - out.normal.dot(change) * out.normal;
  return out;
}

}  // namespace tumble
