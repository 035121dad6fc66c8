// Rates of contact normals, closest points, gaps and tangents. Reference: the same contacts solved
// anew at neighbouring times in fifty digits, and central differences of that; resolution 1e-12 of
// the result's size. Bodies accelerate, so that the second derivative tests the bias of the gap.
#include "engine/dynamics/contact/surface/normal_rate.hpp"

#include "engine/dynamics/contact/surface/element_gap.hpp"
#include "engine/dynamics/contact/surface/tangent_rate.hpp"
#include "engine/math/rotation.hpp"
#include "engine/math/rotation_rates.hpp"
#include "tests/support/precise_motion.hpp"

#include <functional>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Closest points and normal at one time.
struct PreciseContact {
  Precise3 a, b, n;
  Precise gap() const { return n.dot(b - a); }
};
using ContactAt = std::function<PreciseContact(const Precise&)>;

Vec3 rate_vector(Random& r, double size = 1) {
  const double x = r.uniform(-size, size), y = r.uniform(-size, size);
  return {x, y, r.uniform(-size, size)};
}

FrameMotion frame(const PreciseMotion& m) {
  return {m.x, m.v, m.omega};
}

/// Everything in a NormalRate against differences.
void check_rates(const NormalRate& r, const PreciseMotion& a, const PreciseMotion& b,
                 const ContactAt& at) {
  const PreciseContact now = at(Precise(0));
  CHECK((r.normal - rounded(now.n)).norm() < 1e-13);
  CHECK((r.point_a - rounded(now.a)).norm() < 1e-12);
  CHECK((r.point_b - rounded(now.b)).norm() < 1e-12);
  CHECK(std::fabs(r.gap - static_cast<double>(now.gap())) < 1e-13);
  const auto normal = [&](const Precise& t) { return at(t).n; };
  const auto point_a = [&](const Precise& t) { return at(t).a; };
  const auto point_b = [&](const Precise& t) { return at(t).b; };
  const auto gap = [&](const Precise& t) { return at(t).gap(); };
  const double size = 1 + r.normal_rate.norm() + r.point_rate_a.norm() + r.point_rate_b.norm();
  CHECK((r.normal_rate - rounded(central_rate(normal))).norm() < 1e-12 * size);
  CHECK((r.point_rate_a - rounded(central_rate(point_a))).norm() < 1e-12 * size);
  CHECK((r.point_rate_b - rounded(central_rate(point_b))).norm() < 1e-12 * size);
  CHECK(std::fabs(r.gap_rate - static_cast<double>(central_rate(gap))) < 1e-12 * size);

  const Vec3 lever_a = r.point_a - a.x, lever_b = r.point_b - b.x;
  const Vec3 driven = (b.a + b.alpha.cross(lever_b)) - (a.a + a.alpha.cross(lever_a));
  const double second = static_cast<double>(central_second_rate(gap));
  CHECK(std::fabs(r.normal.dot(driven) + r.gap_bias - second) < 1e-12 * size * size);

  // Relative velocity of the material points at the travelling closest points.
  const auto velocity = [&](const Precise& t) {
    const PreciseContact c = at(t);
    const auto of = [&t](const PreciseMotion& m, const Precise3& p) {
      const Precise3 x = precise(m.x) + precise(m.v) * t + precise(m.a) * (t * t / 2);
      const Precise3 w = precise(m.omega) + precise(m.alpha) * t;  // to first order in t
      return precise(m.v) + precise(m.a) * t + w.cross(p - x);
    };
    return of(b, c.b) - of(a, c.a);
  };
  CHECK((r.relative_velocity - rounded(velocity(Precise(0)))).norm() < 1e-12 * size);
  CHECK((driven + r.velocity_bias - rounded(central_rate(velocity))).norm() < 1e-12 * size * size);
}

PreciseContact round_contact(const Precise3& p, double rp, const Precise3& q, double rq) {
  const Precise3 n = unit(q - p);
  return {p + n * Precise(rp), q - n * Precise(rq), n};
}

Precise3 foot(const Precise3& p, const Precise3& e, const Precise3& q) {
  return p + e * ((q - p).dot(e) / e.squared());
}

PreciseContact mirrored(const PreciseContact& c) {
  return {c.b, c.a, -c.n};
}

/// An ellipsoid: centre and half-axes (as vectors), attached to a body.
struct Ellipsoid {
  Vec3 centre;
  Mat3 axes;  ///< columns

  Mat3 quadric() const {  // (p - c)^T Q (p - c) = 1
    Mat3 q = Mat3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double s = axes.col(k).squaredNorm();
      q += axes.col(k) * axes.col(k).transpose() / (s * s);
    }
    return q;
  }
  SmoothPoint smooth(const Vec3& p) const {
    return {p, level_set_curvature(2 * quadric() * (p - centre), 2 * quadric())};
  }
  /// Farthest point along n at time t.
  Precise3 support(const PreciseMotion& m, const Precise3& n, const Precise& t) const {
    Precise3 sum{Precise(0), Precise(0), Precise(0)};
    for (int k = 0; k < 3; ++k) {
      const Precise3 e = m.direction(axes.col(k), t);
      sum = sum + e * e.dot(n);
    }
    return m.point(centre, t) + sum * (1 / sqrt(n.dot(sum - (precise(Vec3::Zero())))));
  }
};

Ellipsoid random_ellipsoid(Random& r, const Vec3& centre) {
  const Mat3 R = axis_angle(rate_vector(r), r.uniform(-3, 3)).toRotationMatrix();
  const double x = r.uniform(0.3, 1), y = r.uniform(0.3, 1);
  return {centre, R * Vec3(x, y, r.uniform(0.3, 1)).asDiagonal()};
}

/// The direction n of greatest n.(b(-n) - a(n)): Newton's method on the tangential part of b - a.
PreciseContact ellipsoid_contact(const Ellipsoid& ea, const PreciseMotion& a, const Ellipsoid& eb,
                                 const PreciseMotion& b, Precise3 n, const Precise& t) {
  const auto between = [&](const Precise3& d) {
    return eb.support(b, -d, t) - ea.support(a, d, t);
  };
  Vec3 u, v;
  tangent_frame(rounded(n).normalized(), u, v);
  const Precise3 t1 = precise(u), t2 = precise(v);
  const Precise h("1e-25");
  for (int i = 0; i < 12; ++i) {
    // F(x, y) = the gap along unit(n + x t1 + y t2): zero gradient. G = (b - a) made tangential.
    const auto G = [&](const Precise3& d) {
      const Precise3 w = between(d);
      return w - d * d.dot(w);
    };
    const Precise3 g = G(n), gx = (G(unit(n + t1 * h)) - g) * (1 / h),
                   gy = (G(unit(n + t2 * h)) - g) * (1 / h);
    const Precise a11 = gx.dot(t1), a12 = gy.dot(t1), a21 = gx.dot(t2), a22 = gy.dot(t2);
    const Precise det = a11 * a22 - a12 * a21, r1 = -g.dot(t1), r2 = -g.dot(t2);
    n = unit(n + t1 * ((r1 * a22 - r2 * a12) / det) + t2 * ((a11 * r2 - a21 * r1) / det));
  }
  return {ea.support(a, n, t), eb.support(b, -n, t), n};
}

}  // namespace

TEST_CASE("normal rates of points: particles, vertices, spheres") {
  Random r(81);
  for (int i = 0; i < 50; ++i) {
    PreciseMotion a = PreciseMotion::random(r), b = PreciseMotion::random(r);
    const bool particles = i % 3 == 0;
    if (particles) a.omega = a.alpha = b.omega = b.alpha = Vec3::Zero();
    const double ra = i % 2 ? 0.3 : 0, rb = i % 2 ? 0.8 : 0;  // overlap too
    const Vec3 p = particles ? a.x : a.x + rate_vector(r),
               q = particles ? b.x : b.x + rate_vector(r);
    const Result<NormalRate> rate =
        normal_rate(frame(a), RoundPoint{p, ra}, frame(b), RoundPoint{q, rb});
    REQUIRE(rate);
    check_rates(*rate, a, b, [&](const Precise& t) {
      return round_contact(a.point(p, t), ra, b.point(q, t), rb);
    });
    if (particles && ra == 0) {
      // Two particles: the gap's bias is the square of the tangential velocity over the distance.
      const Vec3 v = b.v - a.v, tangential = v - rate->normal.dot(v) * rate->normal;
      CHECK(rate->gap_bias == doctest::Approx(tangential.squaredNorm() / (q - p).norm()));
    }
  }
}

TEST_CASE("normal rates of a vertex or a sphere on a face, either way round") {
  Random r(82);
  for (int i = 0; i < 50; ++i) {
    const PreciseMotion a = PreciseMotion::random(r), b = PreciseMotion::random(r);
    const Vec3 f = a.x + rate_vector(r), n = rate_vector(r).normalized(), q = b.x + rate_vector(r);
    const double radius = i % 2 ? 0.4 : 0;
    const auto at = [&](const Precise& t) {
      const Precise3 m = unit(a.direction(n, t)), c = b.point(q, t);
      const Precise d = m.dot(c - a.point(f, t));
      return PreciseContact{c - m * d, c - m * Precise(radius), m};
    };
    const Result<NormalRate> rate =
        normal_rate(frame(a), FlatFace{f, n}, frame(b), RoundPoint{q, radius});
    REQUIRE(rate);
    check_rates(*rate, a, b, at);
    const Result<NormalRate> turned =
        normal_rate(frame(b), RoundPoint{q, radius}, frame(a), FlatFace{f, n});
    REQUIRE(turned);
    check_rates(*turned, b, a, [&](const Precise& t) { return mirrored(at(t)); });
  }
  // At gap 0 the bias is Baraff's 2 n'.v and the centripetal accelerations.
  const FrameMotion a{{0, 0, 0}, {0.3, 0, 1}, {1, 2, 3}}, b{{1, 2, 1}, {2, -1, 0}, {0.5, -1, 2}};
  const Vec3 p(1, 0, 2), n(0, 1, 0);
  const Result<NormalRate> rate = normal_rate(a, FlatFace{p, n}, b, RoundPoint{p, 0});
  REQUIRE(rate);
  const Vec3 v = b.velocity_at(p) - a.velocity_at(p);
  const Vec3 centripetal =
      b.omega.cross(b.omega.cross(p - b.x_world)) - a.omega.cross(a.omega.cross(p - a.x_world));
  CHECK(rate->gap_bias ==
        doctest::Approx(2 * a.omega.cross(n).dot(v) + n.dot(centripetal)).epsilon(1e-13));
}

TEST_CASE("normal rates of a vertex or a sphere at an edge or a capsule, either way round") {
  Random r(83);
  for (int i = 0; i < 50; ++i) {
    const PreciseMotion a = PreciseMotion::random(r), b = PreciseMotion::random(r);
    const Vec3 p = a.x + rate_vector(r), e = rate_vector(r, 3), q = b.x + rate_vector(r);
    const double rl = i % 2 ? 0.2 : 0, rp = i % 3 ? 0.1 : 0;
    const auto at = [&](const Precise& t) {
      const Precise3 c = b.point(q, t);
      return round_contact(foot(a.point(p, t), a.direction(e, t), c), rl, c, rp);
    };
    const Result<NormalRate> rate =
        normal_rate(frame(a), RoundLine{p, e, rl}, frame(b), RoundPoint{q, rp});
    REQUIRE(rate);
    check_rates(*rate, a, b, at);
    const Result<NormalRate> turned =
        normal_rate(frame(b), RoundPoint{q, rp}, frame(a), RoundLine{p, e, rl});
    REQUIRE(turned);
    check_rates(*turned, b, a, [&](const Precise& t) { return mirrored(at(t)); });
  }
}

TEST_CASE("normal rates of edges and capsules that cross, apart, touching and overlapping") {
  Random r(84);
  for (int i = 0; i < 60; ++i) {
    const PreciseMotion a = PreciseMotion::random(r), b = PreciseMotion::random(r);
    const Vec3 e = rate_vector(r), f = rate_vector(r), p = a.x + rate_vector(r);
    // Every third pair of lines meets in a point.
    const Vec3 q = i % 3 ? b.x + rate_vector(r) : Vec3(p + 0.3 * e - 0.7 * f);
    const double ra = i % 2 ? 0.2 : 0, rb = i % 2 ? 0.1 : 0, side = i % 4 < 2 ? 1 : -1;
    const Vec3 towards = side * e.cross(f);
    const auto at = [&](const Precise& t) {
      const Precise3 o = a.point(p, t), s = a.direction(e, t), c = b.point(q, t),
                     d = b.direction(f, t);
      const Precise3 n = unit(s.cross(d)) * Precise(side);
      // Where each line meets the plane through the other and n.
      const Precise3 na = s.cross(n), nb = d.cross(n);
      const Precise3 w = o + s * ((c - o).dot(nb) / s.dot(nb)),
                     x = c + d * ((o - c).dot(na) / d.dot(na));
      return PreciseContact{w + n * Precise(ra), x - n * Precise(rb), n};
    };
    const Result<NormalRate> rate =
        normal_rate(frame(a), RoundLine{p, e, ra}, frame(b), RoundLine{q, f, rb}, towards);
    REQUIRE(rate);
    check_rates(*rate, a, b, at);
  }
}

TEST_CASE("normal rates of smooth surfaces by their curvatures: ellipsoids") {
  Random r(85);
  int overlapping = 0;
  for (int i = 0; i < 20; ++i) {
    PreciseMotion a = PreciseMotion::random(r), b = PreciseMotion::random(r);
    const Ellipsoid ea = random_ellipsoid(r, a.x + 0.3 * rate_vector(r));
    // From overlapping a little to well apart.
    const Ellipsoid eb =
        random_ellipsoid(r, ea.centre + r.uniform(0.7, 2.5) * rate_vector(r).normalized());
    b.x = eb.centre + 0.3 * rate_vector(r);
    Precise3 start = unit(precise(eb.centre - ea.centre));
    // A few fixed-point steps towards the closest points, then Newton's.
    for (int k = 0; k < 200; ++k) {
      const Precise zero(0);
      const Precise3 w = eb.support(b, -start, zero) - ea.support(a, start, zero);
      start = unit(start + (w - start * start.dot(w)) * Precise(0.2));
    }
    const PreciseContact now = ellipsoid_contact(ea, a, eb, b, start, Precise(0));
    REQUIRE(length((now.b - now.a) - now.n * now.gap()) < Precise("1e-40"));
    const Vec3 n = rounded(now.n), p = rounded(now.a), q = rounded(now.b);
    const Result<NormalRate> rate = normal_rate(frame(a), ea.smooth(p), frame(b), eb.smooth(q), n);
    REQUIRE(rate);
    check_rates(*rate, a, b,
                [&](const Precise& t) { return ellipsoid_contact(ea, a, eb, b, now.n, t); });
    overlapping += rate->gap < 0;
  }
  CHECK(overlapping > 3);
  CHECK(overlapping < 17);
}

TEST_CASE("the general smooth contact agrees with spheres, and with a sphere on a plane") {
  Random r(86);
  for (int i = 0; i < 50; ++i) {
    const FrameMotion a = frame(PreciseMotion::random(r)), b = frame(PreciseMotion::random(r));
    const RoundPoint p{a.x_world + rate_vector(r), 0.4}, q{b.x_world + rate_vector(r), 0.3};
    const auto same = [](const NormalRate& x, const NormalRate& y) {
      const double size = 10 * (1 + x.normal_rate.norm()) * (1 + x.normal_rate.norm());
      CHECK((x.normal_rate - y.normal_rate).norm() < 1e-12 * size);
      CHECK((x.point_rate_a - y.point_rate_a).norm() < 1e-12 * size);
      CHECK((x.point_rate_b - y.point_rate_b).norm() < 1e-12 * size);
      CHECK(std::fabs(x.gap_bias - y.gap_bias) < 1e-11 * size);
    };
    const auto sphere = [](const RoundPoint& s, const Vec3& at) {
      const Vec3 n = (at - s.x_world).normalized();
      return SmoothPoint{at, (Mat3::Identity() - n * n.transpose()) / s.radius};
    };
    const Result<NormalRate> two = normal_rate(a, p, b, q);
    REQUIRE(two);
    const Result<NormalRate> general =
        normal_rate(a, sphere(p, two->point_a), b, sphere(q, two->point_b), two->normal);
    REQUIRE(general);
    same(*two, *general);
    const FlatFace face{rate_vector(r), rate_vector(r).normalized()};
    const Result<NormalRate> flat = normal_rate(a, face, b, q);
    REQUIRE(flat);
    const Result<NormalRate> smooth = normal_rate(a, SmoothPoint{flat->point_a, Mat3::Zero()}, b,
                                                  sphere(q, flat->point_b), flat->normal);
    REQUIRE(smooth);
    same(*flat, *smooth);
  }
}

TEST_CASE("contacts without a normal are refused with a reason") {
  const FrameMotion m;
  const RoundPoint p{{1, 2, 3}, 0.5};
  CHECK(!normal_rate(m, p, m, p));
  const RoundLine e{{0, 2, 3}, {1, 0, 0}, 0}, f{{0, 3, 3}, {-2, 0, 0}, 0};
  CHECK(!normal_rate(m, e, m, p));
  CHECK(!normal_rate(m, RoundLine{{0, 0, 0}, {0, 0, 0}, 0}, m, p));
  const Result<NormalRate> parallel = normal_rate(m, e, m, f, Vec3::UnitY());
  REQUIRE(!parallel);
  CHECK(parallel.error().text().find("parallel") != std::string::npos);
  const RoundLine g{{0, 3, 3}, {0, 0, 1}, 0};
  CHECK(normal_rate(m, e, m, g, Vec3::UnitY()));
  CHECK(!normal_rate(m, e, m, g, Vec3::UnitX()));
  Mat3 cylinder = Mat3::Zero();
  cylinder(0, 0) = 2;
  CHECK(!normal_rate(m, SmoothPoint{}, m, SmoothPoint{Vec3::Zero(), cylinder}, Vec3::UnitY()));
  CHECK(!normal_rate(m, SmoothPoint{}, m, SmoothPoint{}, Vec3::UnitY()));
  CHECK(!normal_rate(m, RoundPoint{{NAN, 0, 0}, 0}, m, p));
}

TEST_CASE("rates of tangents: those that follow the normal, and those along the slip") {
  Random r(87);
  for (int i = 0; i < 50; ++i) {
    const Vec3 n = rate_vector(r).normalized(), w = rate_vector(r, 3), v = rate_vector(r),
               a = rate_vector(r, 4);
    const Vec3 n_rate = w.cross(n);
    const PreciseMotion turn{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), w, Vec3::Zero()};
    const auto slip = [&](const Precise& t) {
      const Precise3 m = unit(turn.direction(n, t)), u = precise(v) + precise(a) * t;
      return unit(u - m * m.dot(u));
    };
    const auto across = [&](const Precise& t) { return unit(turn.direction(n, t)).cross(slip(t)); };
    TangentRate rate;
    REQUIRE(slip_tangent_rate(n, n_rate, v, a, rate));
    const double size = 1 + rate.t1_rate.norm();
    CHECK((rate.t1 - rounded(slip(Precise(0)))).norm() < 1e-12 * size);
    CHECK((rate.t2 - rounded(across(Precise(0)))).norm() < 1e-12 * size);
    CHECK((rate.t1_rate - rounded(central_rate(slip))).norm() < 1e-12 * size * size);
    CHECK((rate.t2_rate - rounded(central_rate(across))).norm() < 1e-12 * size * size);

    // Without spin about the normal: the turn of the body less its part along n.
    const PreciseMotion shortest{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), w - n.dot(w) * n,
                                 Vec3::Zero()};
    Vec3 t1, t2;
    tangent_frame(n, t1, t2);
    const auto followed = [&](const Precise& t) { return shortest.direction(t1, t); };
    CHECK((follow_normal_rate(n, n_rate, t1) - rounded(central_rate(followed))).norm() < 1e-13);
  }
  TangentRate rate;
  CHECK(!slip_tangent_rate(Vec3::UnitY(), Vec3::UnitX(), 3 * Vec3::UnitY(), Vec3::UnitX(), rate));
}

TEST_CASE("gaps of surface elements, differentiated by machine, have the rates written out here") {
  Random r(88);
  for (int i = 0; i < 60; ++i) {
    const PreciseMotion ma = PreciseMotion::random(r), mb = PreciseMotion::random(r);
    const FrameMotion a = frame(ma), b = frame(mb);
    const BodyMotion body_a{{a.x_world, Quat::Identity()}, a.v, a.omega};
    const BodyMotion body_b{{b.x_world, Quat::Identity()}, b.v, b.omega};
    const Vec3 p = rate_vector(r), q = rate_vector(r), e = rate_vector(r).normalized(),
               f = rate_vector(r).normalized();
    const double rp = i % 2 ? 0.2 : 0, rq = 0.1;
    const SurfaceElement point_a{ElementKind::point, p, Vec3::UnitY(), rp},
        point_b{ElementKind::point, q, Vec3::UnitY(), rq}, line_a{ElementKind::line, p, e, rp},
        line_b{ElementKind::line, q, f, rq}, plane_a{ElementKind::plane, p, e, 0};
    const RoundPoint pa{a.x_world + p, rp}, pb{b.x_world + q, rq};
    const RoundLine la{a.x_world + p, e, rp}, lb{b.x_world + q, f, rq};
    const FlatFace fa{a.x_world + p, e};
    const Vec3 across = e.cross(f), between = b.x_world + q - a.x_world - p;
    const Vec3 towards = across.dot(between) < 0 ? Vec3(-across) : across;
    const auto same = [&](const SurfaceElement& x, const SurfaceElement& y,
                          const Result<NormalRate>& rate) {
      REQUIRE(rate);
      const ElementGap gap = element_gap(x, body_a, y, body_b, rate->normal);
      REQUIRE(gap.regular);
      const double size =
          1 + rate->normal_rate.norm() + rate->point_rate_a.norm() + rate->point_rate_b.norm();
      CHECK((gap.normal - rate->normal).norm() < 1e-12);
      CHECK(std::fabs(gap.gap - rate->gap) < 1e-12);
      CHECK(std::fabs(gap.rate - rate->gap_rate) < 1e-12 * size);
      CHECK(std::fabs(gap.bias - rate->gap_bias) < 1e-12 * size * size);
    };
    same(point_a, point_b, normal_rate(a, pa, b, pb));
    same(line_a, point_b, normal_rate(a, la, b, pb));
    same(plane_a, point_b, normal_rate(a, fa, b, pb));
    same(line_a, line_b, normal_rate(a, la, b, lb, towards));
  }
}
