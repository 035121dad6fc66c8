// Ellipsoids. References: the definition of the nearest point (on the surface, the way to it along
// the gradient, no sample nearer: resolution 1e-12 of the size); pairs put together at a known
// point, normal and gap, whose distance is that gap because the planes across the normal part them;
// a ball's closed forms; GJK for the closed forms of other shapes.
#include "engine/collision/shapes/ellipsoid.hpp"

#include "engine/collision/gjk/epa.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "tests/collision/support.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

/// Families of semi-axes: any, two equal, a ball, needle, plate, needle of 1 : 10^6.
Vec3 draw_axes(Random& r, int family) {
  const double a = r.uniform(0.2, 1), b = r.uniform(0.2, 1), c = r.uniform(0.2, 1);
  switch (family % 6) {
    case 0:
      return {a, b, c};
    case 1:
      return {a, b, a};
    case 2:
      return {a, a, a};
    case 3:
      return {1e-3 * a, b, 1e-3 * c};
    case 4:
      return {a, 1e-3 * b, c};
    default:
      return {a, 1e-6, 1e-6};
  }
}

/// Points far, near, inside, in planes of symmetry, on axes, the centre.
Vec3 draw_point(Random& r, const Vec3& axes, int family) {
  Vec3 p = random_direction(r).cwiseProduct(axes) * r.uniform(0, 2.5);
  switch (family % 5) {
    case 0:
      return p;
    case 1:
      return p + random_vec(r, -2, 2);
    case 2:
      p[int(r.below(3))] = 0;
      return p;
    case 3: {
      const int k = int(r.below(3));
      p[k] = p[(k + 1) % 3] = 0;
      return p;
    }
    default:
      return r.below(10) ? random_direction(r).cwiseProduct(axes) : Vec3::Zero();
  }
}

double level(const Vec3& axes, const Vec3& p) {
  return p.cwiseQuotient(axes).norm();
}

}  // namespace

TEST_CASE("the nearest point of an ellipsoid is on it, straight below, and no other is nearer") {
  Random r(501);
  int inside = 0;
  const int n = cases(60000);
  for (int i = 0; i < n; ++i) {
    const Vec3 axes = draw_axes(r, i), p = draw_point(r, axes, i / 6);
    const SurfacePoint s = nearest_on_ellipsoid(axes, p);
    const double size = axes.maxCoeff() + p.norm();
    const bool in = level(axes, p) < 1;
    inside += in;
    CAPTURE(axes.transpose());
    CAPTURE(p.transpose());
    CHECK(std::abs(level(axes, s.x) - 1) < 1e-9);
    CHECK(std::abs(s.normal.norm() - 1) < 1e-14);
    CHECK((s.x + s.distance * s.normal - p).norm() < 1e-12 * size);
    const Vec3 gradient = s.x.cwiseQuotient(axes).cwiseQuotient(axes).normalized();
    CHECK((s.normal - gradient).norm() < 1e-9);
    CHECK((in ? s.distance <= 1e-15 * size : s.distance >= -1e-15 * size));
    for (int k = 0; k < 10; ++k) {
      Vec3 d = random_direction(r);
      if (k % 2) d = (s.x.cwiseQuotient(axes) + 0.1 * d).normalized();
      CHECK((d.cwiseProduct(axes) - p).norm() >= std::abs(s.distance) - 1e-12 * size);
    }
  }
  if (n >= 1000) CHECK((inside > 0.2 * n && inside < 0.8 * n));
}

TEST_CASE("closed forms of nearest points are GJK's answers") {
  Random r(502);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.5), capsule(0.3, 0.8),
                                                         box({0.3, 0.4, 0.5}), cylinder(0.4, 0.7),
                                                         ellipsoid({0.5, 0.3, 0.4})};
  const auto speck = sphere(1e-6);
  int inside = 0;
  for (int i = 0; i < cases(20000); ++i) {
    const ConvexShape& shape = *shapes[r.below(uint32_t(shapes.size()))]->convex();
    const Vec3 p = random_vec(r, -1, 1);
    const SurfacePoint s = *shape.nearest(p);
    const PlacedCore A(shape, Quat::Identity(), Vec3::Zero()),
        B(*speck->convex(), Quat::Identity(), p);
    const GjkResult g = gjk(A, B);
    if (g.status != GjkStatus::intersecting) {
      CHECK(std::abs(s.distance - (g.distance - shape.rounding())) < 1e-9);
      if (g.distance > 1e-3) CHECK((s.normal - g.normal).norm() < 1e-4);
    } else {
      ++inside;
      const EpaResult e = epa(A, B, g.simplex);
      CHECK(std::abs(s.distance + e.depth + shape.rounding()) < 1e-6);
    }
    CHECK((s.x + s.distance * s.normal - p).norm() < 1e-14);
  }
  CHECK(inside > 0);
}

TEST_CASE("bounds, supports and masses of ellipsoids") {
  Random r(503);
  for (int i = 0; i < cases(300); ++i) {
    const Vec3 axes = draw_axes(r, i);
    const auto s = ellipsoid(axes);
    const Pose pose{random_vec(r, -2, 2), random_rotation(r)};
    const Aabb bounds = s->bounds(pose);
    const Vec3 d = random_direction(r);
    const double most = d.dot(s->convex()->support(d));
    CHECK(level(axes, s->convex()->support(d)) == doctest::Approx(1).epsilon(1e-12));
    Vec3 reached = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {  // the gradient at the extreme points is along the axis
      const Vec3 out = pose.inverse_direction(Vec3::Unit(k));
      const Vec3 tip = axes.cwiseProduct(axes).cwiseProduct(out) / axes.cwiseProduct(out).norm();
      reached[k] = pose.point(tip)[k];
    }
    CHECK((bounds.max - reached).norm() < 1e-14 * 10);
    for (int k = 0; k < 50; ++k) {
      const Vec3 x = random_direction(r).cwiseProduct(axes);
      CHECK(bounds.inflated(1e-12).contains(pose.point(x)));
      CHECK(d.dot(x) <= most + 1e-12);
    }
  }
  // By the moments of the unit ball: m/5 along each axis.
  const auto m = ellipsoid({1, 2, 3})->mass_properties();
  REQUIRE(m.ok());
  CHECK(m->mass == doctest::Approx(4.0 / 3 * det::pi * 6).epsilon(1e-14));
  const Vec3 moments = m->mass / 5 * Vec3(4 + 9, 1 + 9, 1 + 4);
  CHECK((m->inertia - Mat3(moments.asDiagonal())).norm() < 1e-12 * moments.norm());
}

TEST_CASE("rays on ellipsoids: the root of the quadratic, normals along the gradient") {
  Random r(504);
  int hits = 0;
  for (int i = 0; i < cases(5000); ++i) {
    const Vec3 axes = draw_axes(r, i);
    const auto s = ellipsoid(axes);
    const Vec3 from = 3 * random_direction(r);
    const Vec3 d = (random_vec(r, -1, 1).cwiseProduct(axes) - from) * r.uniform(0.5, 2);
    const Vec3 u = from.cwiseQuotient(axes), w = d.cwiseQuotient(axes);
    const double b = u.dot(w), disc = b * b - w.dot(w) * (u.dot(u) - 1);
    const auto hit = s->ray_cast(from, d, 10);
    if (std::abs(disc) < 1e-9 * b * b) continue;
    REQUIRE(hit.has_value() == (disc > 0));
    if (!hit) continue;
    ++hits;
    const Vec3 x = from + hit->t * d;
    CHECK(std::abs(nearest_on_ellipsoid(axes, x).distance) < 1e-12);
    const Vec3 gradient = x.cwiseQuotient(axes).cwiseQuotient(axes).normalized();
    CHECK(hit->normal.dot(d) < 0);
    if (i % 6 < 3) CHECK((hit->normal - gradient).norm() < 1e-9);
  }
  CHECK(hits > 0);
  const auto inside = ellipsoid({1, 2, 3})->ray_cast({0.1, 0.2, 0.3}, {0, 0, 2}, 10);
  REQUIRE(inside);
  CHECK(inside->t == 0);
  CHECK((inside->normal + Vec3::UnitZ()).norm() < 1e-15);
}

TEST_CASE("ellipsoids put together at a normal and a gap have that gap, normal and point") {
  Random r(505);
  int deep = 0;
  for (int i = 0; i < cases(4000); ++i) {
    const Vec3 ea{r.uniform(0.2, 1), r.uniform(0.2, 1), r.uniform(0.2, 1)},
        eb{r.uniform(0.2, 1), r.uniform(0.2, 1), r.uniform(0.2, 1)};
    const auto a = ellipsoid(ea), b = ellipsoid(eb);
    const Vec3 n = random_direction(r);
    const double gap =
        i % 3 == 0 ? -std::pow(10.0, r.uniform(-6, -2.5)) : std::pow(10.0, r.uniform(-6, -1));
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    Pose pb{Vec3::Zero(), random_rotation(r)};
    const Vec3 on_a = pa.point(a->convex()->support(pa.inverse_direction(n)));
    pb.x = on_a + gap * n - pb.direction(b->convex()->support(pb.inverse_direction(-n)));
    std::vector<Manifold> found;
    collide(*a, pa, *b, pb, 0.2, found);
    REQUIRE(found.size() == 1);
    REQUIRE(found[0].count == 1);
    deep += gap < 0;
    CHECK(std::abs(found[0].points[0].gap - gap) < 1e-8);
    CHECK((found[0].normal - n).norm() < 1e-3);
    CHECK((found[0].points[0].x_world - (on_a + 0.5 * gap * n)).norm() < 1e-3);
    CHECK(overlap(*a, pa, *b, pb) == (gap < 0));
    // over a half-space: closed form
    const Pose ground{random_vec(r, -1, 1), random_rotation(r)};
    const Vec3 up = ground.direction(Vec3::UnitY());
    const double low = up.dot(pa.x - ground.x) - ea.cwiseProduct(pa.inverse_direction(up)).norm();
    found.clear();
    collide(*half_space(), ground, *a, pa, 100, found);
    REQUIRE(found.size() == 1);
    CHECK(std::abs(found[0].points[0].gap - low) < 1e-14);
  }
  CHECK(deep > 0);
}
