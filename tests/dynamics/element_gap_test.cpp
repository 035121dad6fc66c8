// Gaps of surface elements. References: central differences of the gap along motions without
// acceleration (h = 1e-4 s: errors about 1e-7); the least distance of rims, edges and corners by
// search in extended precision and its differences; the narrow phase for the gap of real shapes.
#include "engine/dynamics/contact/surface/element_gap.hpp"

#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/nearest_points.hpp"
#include "engine/core/random.hpp"
#include "engine/dynamics/contact/surface/normal_rate.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 draw(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}
Quat draw_rotation(Random& r) {
  Quat q(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  return q.normalized();
}
BodyMotion later(const BodyMotion& m, double t) {
  BodyMotion out = m;
  out.pose.x += t * m.v;
  out.pose.q = integrate_rotation(m.pose.q, m.omega, t);
  return out;
}
SurfaceElement draw_element(Random& r, ElementKind kind) {
  SurfaceElement e{kind, draw(r, 0.5), draw(r, 1).normalized(), 0};
  if (kind != ElementKind::plane && kind != ElementKind::ellipsoid) e.radius = r.uniform(0.05, 0.3);
  if (kind == ElementKind::cone) e.taper = r.uniform(-0.7, 0.7);
  if (kind == ElementKind::ellipsoid)
    e.semi_axes = draw_rotation(r).toRotationMatrix() *
                  Vec3(r.uniform(0.1, 0.5), r.uniform(0.1, 0.5), r.uniform(0.1, 0.5)).asDiagonal();
  return e;
}

}  // namespace

TEST_CASE("rate and bias of every pair of elements are the derivatives of its gap") {
  using enum ElementKind;
  Random r(21);
  int jumps = 0;
  for (const ElementKind ka : {point, line, plane, circle, ellipsoid, cone}) {
    for (const ElementKind kb : {point, line, plane, circle, ellipsoid, cone}) {
      if (!known_pair(ka, kb)) continue;
      for (int i = 0; i < 200; ++i) {
        const SurfaceElement a = draw_element(r, ka), b = draw_element(r, kb);
        BodyMotion ma{{draw(r, 1), draw_rotation(r)}, draw(r, 1), draw(r, 2)};
        BodyMotion mb{{draw(r, 1) + Vec3(3, 0, 0), draw_rotation(r)}, draw(r, 1), draw(r, 2)};
        const Vec3 side = mb.pose.x - ma.pose.x;
        const ElementGap now = element_gap(a, ma, b, mb, side);
        const ElementPlace place = element_place(a, ma, b, mb, side);
        CHECK(place.regular == now.regular);
        if (!now.regular) continue;
        CHECK(place.gap == now.gap);
        CHECK(place.normal == now.normal);
        CHECK(place.x_world == now.x_world);
        constexpr double h = 1e-4;
        const ElementGap next = element_gap(a, later(ma, h), b, later(mb, h), now.normal);
        const ElementGap last = element_gap(a, later(ma, -h), b, later(mb, -h), now.normal);
        // Nearly parallel lines run along each other fast.
        const double size = 1 + std::fabs(now.bias);
        if (size > 1e3) continue;
        // Circles far from each other have several nearest pairs; one may end meanwhile.
        const double jump =
            std::max((next.x_world - now.x_world).norm(), (last.x_world - now.x_world).norm());
        if (jump > 0.01) {
          ++jumps;
          continue;
        }
        CHECK(std::fabs((next.gap - last.gap) / (2 * h) - now.rate) < 1e-5 * size * size);
        CHECK(std::fabs((next.gap - 2 * now.gap + last.gap) / (h * h) - now.bias) <
              1e-4 * size * size);
        const Vec3 u = mb.v + mb.omega.cross(now.x_world - mb.pose.x) - ma.v -
                       ma.omega.cross(now.x_world - ma.pose.x);
        // The point is midway: the surfaces are gap/2 away, which turns move apart.
        const Vec3 half = 0.5 * now.gap * now.normal;
        const Vec3 at_ends = u + mb.omega.cross(half) - ma.omega.cross(-half);
        CHECK(now.normal.dot(at_ends) == doctest::Approx(now.rate).scale(1).epsilon(1e-9));
        const ElementGap other = element_gap(b, mb, a, ma, -side);
        CHECK(other.gap == doctest::Approx(now.gap).scale(1).epsilon(1e-12));
        CHECK((other.normal + now.normal).norm() < 1e-12);
        CHECK(other.bias == doctest::Approx(now.bias).scale(size).epsilon(1e-7));
      }
    }
  }
  CHECK(jumps < 20);
}

namespace {

using Precise3 = Vector3<long double>;

/// Rodrigues' formula about a unit axis.
Matrix3<long double> precise_turn(const Precise3& u, long double angle) {
  const Matrix3<long double> k(0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0);
  return Matrix3<long double>::Identity() + sinl(angle) * k + (1 - cosl(angle)) * (k * k);
}

/// A rim, edge or corner at a moment, in extended precision.
struct PreciseCurve {
  ElementKind kind;
  Precise3 origin, direction, e1, e2;
  long double radius;

  /// The motion without acceleration: the rotation vector grows evenly.
  PreciseCurve(const SurfaceElement& e, const BodyMotion& m, long double t)
      : kind(e.kind), radius(e.radius) {
    const Quaternion<long double> q0 = m.pose.q.cast<long double>().normalized();
    const Precise3 w = m.omega.cast<long double>();
    const long double angle = w.norm() * t;
    const Quaternion<long double> q(precise_turn(w.normalized(), angle) * q0.toRotationMatrix());
    origin = m.pose.x.cast<long double>() + t * m.v.cast<long double>() +
             q * e.origin.cast<long double>();
    const Precise3 d = e.direction.cast<long double>().normalized();
    const Precise3 other = std::fabs(d.x()) < 0.5L ? Precise3::UnitX() : Precise3::UnitY();
    direction = q * d, e1 = q * d.cross(other).normalized();
    e2 = direction.cross(e1);
  }
  Precise3 at(long double s) const {
    if (kind == ElementKind::line) return origin + s * direction;
    if (kind == ElementKind::point) return origin;
    return origin + radius * (std::cos(s) * e1 + std::sin(s) * e2);
  }
  long double distance(const Precise3& p) const {
    const Precise3 d = p - origin;
    if (kind == ElementKind::point) return d.norm();
    const long double along = d.dot(direction);
    const long double across = (d - along * direction).norm();
    if (kind == ElementKind::line) return across;
    return std::hypot(along, across - radius);
  }
};

/// The least distance over the points of a near s, by golden section; s becomes where it is.
long double least_distance(const PreciseCurve& a, const PreciseCurve& b, long double& s,
                           long double width) {
  const long double golden = 0.61803398874989484820458683436563812L;
  long double lo = s - width, hi = s + width;
  while (hi - lo > 1e-11L) {
    const long double x = hi - golden * (hi - lo), y = lo + golden * (hi - lo);
    (b.distance(a.at(x)) < b.distance(a.at(y)) ? hi : lo) =
        b.distance(a.at(x)) < b.distance(a.at(y)) ? y : x;
  }
  s = 0.5L * (lo + hi);
  return b.distance(a.at(s));
}

/// The global search to begin with.
long double coarse(const PreciseCurve& a, const PreciseCurve& b) {
  const long double reach = a.kind == ElementKind::circle ? 3.2L : 4;
  long double best = 0;
  for (int i = -400; i <= 400; ++i) {
    const long double s = reach * i / 400;
    if (b.distance(a.at(s)) < b.distance(a.at(best))) best = s;
  }
  return best;
}

}  // namespace

TEST_CASE("gaps of rims with rims, edges, axes and corners are least distances by search") {
  using enum ElementKind;
  Random r(24);
  int compared = 0;
  for (int i = 0; i < 1200; ++i) {
    const ElementKind ka = circle, kb = i % 3 == 0 ? circle : i % 3 == 1 ? line : point;
    SurfaceElement a = draw_element(r, ka), b = draw_element(r, kb);
    const double round = kb != circle && i % 2 ? b.radius : 0;
    if (kb != circle) b.radius = round;
    const BodyMotion ma{{draw(r, 0.2), draw_rotation(r)}, draw(r, 1), draw(r, 3)};
    const BodyMotion mb{{draw(r, 0.2) + Vec3(0.6, 0, 0), draw_rotation(r)}, draw(r, 1), draw(r, 3)};
    const auto gap = [&](long double t, long double& s) {
      const PreciseCurve pa(a, ma, t), pb(b, mb, t);
      return least_distance(pa, pb, s, 0.1L) - (long double)round;
    };
    const PreciseCurve pa(a, ma, 0), pb(b, mb, 0);
    long double s = coarse(pa, pb);
    const long double g0 = gap(0, s);
    // The direction in which B is: from the nearest point of A away from A's centre.
    Vec3 out = (pa.at(s) - pa.origin).cast<double>();
    const ElementGap now = element_gap(a, ma, b, mb, out);
    if (!now.regular || std::fabs(std::fabs(now.gap + round) - double(g0) - round) > 1e-3) continue;
    const double sign = now.gap + round > 0 ? 1 : -1;
    if (round > 0 && sign < 0) continue;
    constexpr long double h = 2e-4L;
    long double f[5];
    for (int k = 0; k < 5; ++k) {
      long double from = s;
      f[k] = gap((k - 2) * h, from);
    }
    const auto rate = double((f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * h));
    const auto bias = double((-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / (12 * h * h));
    if (std::fabs(bias) > 100 || double(g0) < 0.01) continue;
    ++compared;
    CHECK(sign * now.gap == doctest::Approx(double(g0)).scale(1).epsilon(1e-12));
    CHECK(sign * now.rate == doctest::Approx(rate).scale(1).epsilon(1e-6));
    CHECK(sign * now.bias == doctest::Approx(bias).scale(1).epsilon(1e-4));
  }
  CHECK(compared > 300);
}

TEST_CASE("rims and edges that pass through each other have a gap that changes its sign smoothly") {
  // A rim over a straight edge and along a line through it: the signed gap is linear in time.
  const SurfaceElement rim{ElementKind::circle, Vec3::Zero(), Vec3::UnitY(), 0.5};
  const SurfaceElement edge{ElementKind::line, {0.5, 0, 0}, Vec3(0, 1, 0).normalized(), 0};
  for (const double depth : {1e-3, 1e-6, 1e-9, 0.0, -1e-9, -1e-6, -1e-3}) {
    BodyMotion still, moving;
    moving.pose.x = {depth, 0, 0};
    moving.v = {-1, 0, 0};
    const ElementGap g = element_gap(rim, still, edge, moving, Vec3::UnitX());
    REQUIRE(g.regular);
    CHECK(g.gap == doctest::Approx(depth).scale(1).epsilon(1e-15));
    CHECK(g.rate == doctest::Approx(-1));
    CHECK((g.normal - Vec3::UnitX()).norm() < 1e-12);
  }
}

TEST_CASE("the tangential bias is how the velocity at the contact of rolling bodies changes") {
  // A ball on a ball, both moving anyhow: u along any fixed tangent, at the travelling point.
  Random r(22);
  for (int i = 0; i < 300; ++i) {
    const SurfaceElement a{ElementKind::point, Vec3::Zero(), Vec3::UnitY(), 0.7};
    const SurfaceElement b{i % 2 ? ElementKind::point : ElementKind::plane, Vec3::Zero(),
                           Vec3(0, -1, 0), i % 2 ? 0.4 : 0};
    BodyMotion ma{{Vec3::Zero(), draw_rotation(r)}, draw(r, 1), draw(r, 2)};
    BodyMotion mb{{Vec3(0.1, 1.1, 0.05), Quat::Identity()}, draw(r, 1), draw(r, 2)};
    const auto u = [&](const BodyMotion& p, const BodyMotion& q) {
      const Vec3 x = element_gap(a, p, b, q, Vec3::UnitY()).x_world;
      return Vec3(q.v + q.omega.cross(x - q.pose.x) - p.v - p.omega.cross(x - p.pose.x));
    };
    const ElementGap now = element_gap(a, ma, b, mb, Vec3::UnitY());
    constexpr double h = 1e-5;
    Vec3 change = (u(later(ma, h), later(mb, h)) - u(later(ma, -h), later(mb, -h))) / (2 * h);
    change -= now.normal.dot(change) * now.normal;
    CHECK((change - now.tangential_bias).norm() < 1e-7);
  }
}

TEST_CASE("elements of real shapes have the narrow phase's gap and normal") {
  Random r(23);
  std::vector<BodyShape> shapes;
  ShapeDef capsule;
  capsule.type = ShapeType::capsule;
  capsule.radius = 0.3, capsule.height = 0.8;
  ShapeDef cylinder = capsule;
  cylinder.type = ShapeType::cylinder;
  ShapeDef ground;
  ground.type = ShapeType::half_space;
  const ShapeDef egg = ellipsoid({0.3, 0.4, 0.6});
  const ShapeDef spike{.type = ShapeType::cone, .radius = 0.4, .height = 0.9};
  const ShapeDef bone{
      .type = ShapeType::tapered_capsule, .radius = 0.4, .height = 0.6, .top_radius = 0.2};
  for (const ShapeDef& def :
       {sphere(0.4), box(0.3, 0.5, 0.4), capsule, cylinder, egg, spike, bone, ground}) {
    BodyShape s;
    s.shape = *make_shape(def);
    s.pose = def.type == ShapeType::half_space ? Pose{} : Pose{draw(r, 0.1), draw_rotation(r)};
    shapes.push_back(s);
  }
  int compared = 0, edges = 0, rims = 0, eggs = 0, sides = 0;
  for (int i = 0; i < 16000; ++i) {
    const BodyShape& sa = shapes[r.below(8)];
    const BodyShape& sb = shapes[r.below(7)];
    Pose pa{draw(r, 0.2), draw_rotation(r)}, pb{draw(r, 1.2), draw_rotation(r)};
    std::vector<Manifold> manifolds;
    collide(*sa.shape, pa * sa.pose, *sb.shape, pb * sb.pose, ContactQuery(0.05), manifolds);
    for (const Manifold& m : manifolds) {
      // The first point of a manifold of one is the closest pair; clipped corners of others are
      // measured along the normal, which is the gap only of faces.
      for (int k = 0; k < m.count; ++k) {
        const ManifoldPoint& p = m.points[size_t(k)];
        if (p.gap < 1e-3) continue;
        const Vec3 on_a = p.x_world - 0.5 * p.gap * m.normal,
                   on_b = p.x_world + 0.5 * p.gap * m.normal;
        const SurfaceElement ea =
            element_at(sa, pa.inverse_point(on_a), pa.inverse_direction(m.normal));
        const SurfaceElement eb =
            element_at(sb, pb.inverse_point(on_b), pb.inverse_direction(-m.normal));
        if (!known_pair(ea.kind, eb.kind)) continue;
        const ElementGap g = element_gap(ea, {pa}, eb, {pb}, m.normal);
        if (!g.regular || g.normal.cross(m.normal).norm() > 1e-6) continue;
        CHECK(g.gap == doctest::Approx(p.gap).scale(1).epsilon(1e-6));
        ++compared;
        sides += ea.kind == ElementKind::cone || eb.kind == ElementKind::cone;
        eggs += ea.kind == ElementKind::ellipsoid || eb.kind == ElementKind::ellipsoid;
        rims += ea.kind == ElementKind::circle || eb.kind == ElementKind::circle;
        edges += ea.kind == ElementKind::line && eb.kind == ElementKind::line;
      }
    }
  }
  CHECK(compared > 300);
  CHECK(edges > 10);
  CHECK(rims > 20);
  CHECK(eggs > 50);
  CHECK(sides > 50);
}

TEST_CASE("cones against points, lines, cones, rims and ellipsoids: the planes that part them") {
  // Reference: the best of all planes that part the two, by support functions of a solid of
  // revolution long enough that its ends are not near: the hull of two balls of the cone. The gap
  // is the greatest separation of all normals, which only the cone's own have; by search on a grid
  // around the axis and golden sections (1e-9 m).
  using enum ElementKind;
  Random r(27);
  int compared = 0, kinds[6] = {};
  for (int i = 0; i < 1500; ++i) {
    const SurfaceElement a = draw_element(r, cone);
    const ElementKind other = std::array{point, line, circle, ellipsoid, cone}[size_t(i % 5)];
    const SurfaceElement b = draw_element(r, other);
    const BodyMotion ma{{draw(r, 1), draw_rotation(r)}, Vec3::Zero(), Vec3::Zero()};
    const BodyMotion mb{{draw(r, 1) + Vec3(2, 0, 0), draw_rotation(r)}, Vec3::Zero(), Vec3::Zero()};
    const Vec3 u = ma.pose.direction(a.direction), o = ma.pose.point(a.origin);
    const Vec3 e1 = u.unitOrthogonal(), e2 = u.cross(e1);
    const Vec3 w = mb.pose.direction(b.direction), q = mb.pose.point(b.origin);
    const double out = std::sqrt(1 - a.taper * a.taper);
    const auto normal = [&](double angle) -> Vec3 {
      return out * (std::cos(angle) * e1 + std::sin(angle) * e2) - a.taper * u;
    };
    const auto height_b = [&](const Vec3& m) {  // furthest along m from its origin
      if (other == point) return b.radius;
      if (other == circle) return b.radius * std::sqrt(std::max(0.0, 1 - m.dot(w) * m.dot(w)));
      if (other == ellipsoid)
        return (b.semi_axes.transpose() * (mb.pose.inverse_direction(m))).norm();
      return b.radius;
    };
    const auto apart = [&](double angle) {
      const Vec3 n = normal(angle);
      return n.dot(q - o) - a.radius - height_b(-n);
    };
    double exact = 0;
    Vec3 n_exact;
    if (other == line || other == cone) {
      // n.w = taper of B: roots of that along the circle of normals, the better of the two.
      const auto off = [&](double angle) { return normal(angle).dot(w) - b.taper; };
      bool any = false;
      for (int k = 0; k < 2000; ++k) {
        double lo = k * 2e-3 * det::pi / 2, hi = (k + 1) * 2e-3 * det::pi / 2;
        if (off(lo) * off(hi) > 0) continue;
        for (int step = 0; step < 60; ++step) {
          const double x = 0.5 * (lo + hi);
          (off(lo) * off(x) > 0 ? lo : hi) = x;
        }
        if (any && apart(lo) <= exact) continue;
        any = true, exact = apart(lo), n_exact = normal(lo);
      }
      if (!any) continue;
    } else {
      double best = 0;
      for (double s = -4; s <= 4; s += 0.01)
        if (apart(s) > apart(best)) best = s;
      double lo = best - 0.02, hi = best + 0.02;
      for (int k = 0; k < 80; ++k) {
        const double x = hi - 0.618 * (hi - lo), y = lo + 0.618 * (hi - lo);
        apart(x) > apart(y) ? hi = y : lo = x;
      }
      exact = apart(0.5 * (lo + hi)), n_exact = normal(0.5 * (lo + hi));
    }
    const ElementGap g = element_gap(a, ma, b, mb, n_exact);
    if (!g.regular) continue;
    ++compared, ++kinds[i % 5];
    CHECK(g.gap == doctest::Approx(exact).scale(1).epsilon(1e-8));
    CHECK((g.normal - n_exact).norm() < 1e-4);
    // Midway between a point of the cone and one of the other side.
    const Vec3 on_a = g.x_world - 0.5 * g.gap * g.normal;
    const double along = (on_a - o).dot(u) / out / out;  // of a ball's centre below the surface
    const double ball = along + a.taper * a.radius / out / out;
    CHECK((on_a - (o + ball * u)).norm() ==
          doctest::Approx(std::fabs(a.radius + a.taper * ball)).epsilon(1e-6));
  }
  CHECK(compared > 900);
  for (int k = 0; k < 5; ++k) CHECK(kinds[k] > 80);
}

TEST_CASE("ellipsoids put together at a normal and a gap: gap, rate and bias by their curvature") {
  // References: the construction for gap and normal; §10.3's formulas for any two smooth surfaces
  // by their shape operators for the rest.
  using enum ElementKind;
  Random r(25);
  int overlapping = 0;
  for (int i = 0; i < 2000; ++i) {
    const SurfaceElement a = draw_element(r, ellipsoid), b = draw_element(r, ellipsoid);
    const BodyMotion ma{{draw(r, 1), draw_rotation(r)}, draw(r, 1), draw(r, 3)};
    BodyMotion mb{{Vec3::Zero(), draw_rotation(r)}, draw(r, 1), draw(r, 3)};
    const Vec3 n = draw(r, 1).normalized();
    const double gap = i % 3 ? r.uniform(0, 0.5) : i % 2 ? -r.uniform(0, 0.01) : 0;
    overlapping += gap < 0;
    const auto surface = [](const SurfaceElement& e, const BodyMotion& m, const Vec3& out) {
      const Mat3 A = m.pose.q.toRotationMatrix() * e.semi_axes, S = A * A.transpose();
      SmoothPoint p;
      p.x_world = m.pose.point(e.origin) + S * out / std::sqrt(out.dot(S * out));
      const Mat3 H = S.inverse();
      p.curvature = level_set_curvature(H * (p.x_world - m.pose.point(e.origin)), H);
      return p;
    };
    const SmoothPoint on_a = surface(a, ma, n);
    mb.pose.x = on_a.x_world + gap * n - surface(b, mb, -n).x_world;
    const SmoothPoint on_b = surface(b, mb, -n);
    const auto exact =
        normal_rate({ma.pose.x, ma.v, ma.omega}, on_a, {mb.pose.x, mb.v, mb.omega}, on_b, n);
    REQUIRE(exact.ok());
    const Vec3 start = (n + 0.1 * draw(r, 1)).normalized();
    const ElementGap g = element_gap(a, ma, b, mb, start);
    REQUIRE(g.regular);
    CHECK(g.gap == doctest::Approx(gap).scale(1).epsilon(1e-13));
    CHECK((g.normal - n).norm() < 1e-12);
    CHECK((g.x_world - 0.5 * (on_a.x_world + on_b.x_world)).norm() < 1e-12);
    CHECK(g.rate == doctest::Approx(exact->gap_rate).scale(1).epsilon(1e-11));
    CHECK(g.bias == doctest::Approx(exact->gap_bias).scale(1).epsilon(1e-8));
  }
  CHECK(overlapping > 100);
}

TEST_CASE("ellipsoids against edges, rims, points and planes: the least distance by search") {
  // Reference: the nearest point of the ellipsoid to each of many points, closed in by golden
  // sections (1e-9 m); a plane's by the closed form of its height.
  using enum ElementKind;
  Random r(26);
  int compared = 0;
  for (int i = 0; i < 600; ++i) {
    const SurfaceElement a = draw_element(r, ellipsoid);
    SurfaceElement b = draw_element(r, i % 3 == 0 ? point : i % 3 == 1 ? line : circle);
    if (i % 2 && b.kind != circle) b.radius = 0;
    const BodyMotion ma{{draw(r, 1), draw_rotation(r)}, Vec3::Zero(), Vec3(0.1, 0, 0)};
    const BodyMotion mb{
        {draw(r, 1) + Vec3(1.5, 0, 0), draw_rotation(r)}, Vec3::Zero(), Vec3(0, 0.1, 0)};
    const Mat3 A = ma.pose.q.toRotationMatrix() * a.semi_axes;
    const Vec3 axes(A.col(0).norm(), A.col(1).norm(), A.col(2).norm());
    const Mat3 R = A * axes.cwiseInverse().asDiagonal();
    const Vec3 centre = ma.pose.point(a.origin);
    const auto distance = [&](const Vec3& x) {
      return nearest_on_ellipsoid(axes, R.transpose() * (x - centre)).distance;
    };
    const PreciseCurve curve(b, mb, 0);
    const auto at = [&](double s) { return distance(curve.at(s).cast<double>()); };
    double best = 0;
    for (double s = -4; s <= 4; s += 0.01)
      if (at(s) < at(best)) best = s;
    double lo = best - 0.02, hi = best + 0.02;
    for (int k = 0; k < 60; ++k) {
      const double x = hi - 0.618 * (hi - lo), y = lo + 0.618 * (hi - lo);
      (at(x) < at(y) ? hi : lo) = at(x) < at(y) ? y : x;
    }
    const double round = b.kind == circle ? 0 : b.radius, least = at(0.5 * (lo + hi)) - round;
    if (least < 0.01) continue;
    const Vec3 towards =
        curve.at(0.5L * ((long double)(lo) + (long double)(hi))).cast<double>() - centre;
    const ElementGap g = element_gap(a, ma, b, mb, towards.normalized());
    // the disc inside a rim may be nearer than the rim
    if (b.kind == circle && (!g.regular || g.gap < least - 1e-6)) continue;
    REQUIRE(g.regular);
    ++compared;
    CHECK(g.gap == doctest::Approx(least).scale(1).epsilon(1e-9));
  }
  CHECK(compared > 300);
}
