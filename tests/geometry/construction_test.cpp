// Closest points and projections. References: the optimality conditions of the convex problem
// (no feasible direction improves; exact for projections on convex sets), and dense sampling.
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// x is the nearest point of the convex hull of `corners` to p exactly when no corner lies further
/// towards p than x: (p - x).(c - x) <= 0 for every corner c.
double violation(const Vec3& p, const Vec3& x, std::initializer_list<Vec3> corners) {
  double worst = 0;
  for (const Vec3& c : corners) worst = std::max(worst, (p - x).dot(c - x));
  return worst;
}

/// Triangles of every kind: wide, thin, without area, tiny, far away.
std::array<Vec3, 3> any_triangle(Random& r, int kind) {
  std::array<Vec3, 3> t = draws::triangle(r);
  switch (kind % 6) {
    case 1:  // sliver
      t[2] = t[0] + r.uniform() * (t[1] - t[0]) + 1e-9 * draws::direction(r);
      break;
    case 2:  // needle
      t[1] = t[0] + 1e-9 * draws::direction(r);
      break;
    case 3:  // collinear
      t[2] = 0.5 * (t[0] + t[1]);
      break;
    case 4:  // a point
      t[1] = t[2] = t[0];
      break;
    default:
      break;
  }
  return t;
}

}  // namespace

TEST_CASE("closest point of a triangle satisfies the optimality conditions") {
  Random random(40);
  int faces = 0, edges = 0, vertices = 0;
  const int n = draws::count(100000);
  for (int i = 0; i < n; ++i) {
    const auto t = any_triangle(random, i);
    const double distance = i % 7 == 0 ? 100 : (i % 7 == 1 ? 1e-7 : 1.5);
    const Vec3 p = distance * draws::in_box(random, 1) + (i % 7 == 1 ? t[0] : Vec3::Zero());
    const TrianglePoint c = closest_on_triangle(p, t[0], t[1], t[2]);
    const double size = 2 + p.norm();
    CHECK(violation(p, c.point, {t[0], t[1], t[2]}) < 1e-12 * size * size);
    const Vec3 x = c.barycentric.x() * t[0] + c.barycentric.y() * t[1] + c.barycentric.z() * t[2];
    CHECK((x - c.point).norm() < 1e-14 * size);
    CHECK(c.barycentric.minCoeff() >= 0);
    CHECK(c.barycentric.sum() == doctest::Approx(1).epsilon(1e-14));
    CHECK(c.squared_distance == doctest::Approx((p - c.point).squaredNorm()));
    const int zeros = int((c.barycentric.array() == 0).count());
    if (is_vertex(c.feature)) {
      CHECK(c.barycentric[feature_index(c.feature)] == 1);
      ++vertices;
    } else if (is_edge(c.feature)) {
      CHECK(c.barycentric[(feature_index(c.feature) + 2) % 3] == 0);
      CHECK(zeros == 1);
      ++edges;
    } else {
      CHECK(zeros == 0);
      CHECK(i % 6 != 3);
      CHECK(i % 6 != 4);
      ++faces;
    }
  }
  if (n > 1000) {
    CHECK(faces > n / 50);
    CHECK(edges > n / 20);
    CHECK(vertices > n / 20);
  }
}

TEST_CASE("closest points of segments satisfy the optimality conditions") {
  Random random(41);
  const int n = draws::count(100000);
  int inner = 0;
  for (int i = 0; i < n; ++i) {
    Vec3 a0 = draws::in_box(random, 1), a1 = draws::in_box(random, 1);
    Vec3 b0 = draws::in_box(random, 1), b1 = draws::in_box(random, 1);
    switch (i % 8) {
      case 1:  // parallel
        b1 = b0 + random.uniform(-2, 2) * (a1 - a0);
        break;
      case 2:  // nearly parallel
        b1 = b0 + (a1 - a0) + 1e-7 * draws::direction(random);
        break;
      case 3:  // collinear
        b0 = a0 + random.uniform(-2, 2) * (a1 - a0);
        b1 = a0 + random.uniform(-2, 2) * (a1 - a0);
        break;
      case 4:  // a point
        a1 = a0;
        break;
      case 5:  // crossing at a small angle
        b0 = a0 + 1e-6 * draws::direction(random);
        b1 = a1 + (a0 - b0);
        break;
      case 6:  // points
        a1 = a0;
        b1 = b0;
        break;
      default:
        break;
    }
    const SegmentPair c = closest_segment_segment(a0, a1, b0, b1);
    // Nearest points on each other's segment: both conditions together mean a global minimum.
    const double rounding = i % 8 == 5 || i % 8 == 2 ? 1e-10 : 1e-13;
    CHECK(violation(c.on_b, c.on_a, {a0, a1}) < rounding);
    CHECK(violation(c.on_a, c.on_b, {b0, b1}) < rounding);
    CHECK(c.s >= 0);
    CHECK(c.s <= 1);
    CHECK(c.t >= 0);
    CHECK(c.t <= 1);
    inner += c.s > 0 && c.s < 1 && c.t > 0 && c.t < 1;
  }
  if (n > 1000) CHECK(inner > n / 10);
}

TEST_CASE("closest points of a line and a segment satisfy the optimality conditions") {
  Random random(45);
  int inner = 0;
  const int n = draws::count(50000);
  for (int i = 0; i < n; ++i) {
    const Vec3 o = draws::in_box(random, 1), b0 = draws::in_box(random, 1);
    Vec3 d = random.uniform(0.01, 100) * draws::direction(random), b1 = draws::in_box(random, 1);
    if (i % 6 == 1) b1 = b0 + random.uniform(-2, 2) * d.normalized();            // parallel
    if (i % 6 == 2) b1 = b0 + d.normalized() + 1e-7 * draws::direction(random);  // nearly so
    if (i % 6 == 3) b1 = b0;
    if (i % 6 == 4) d.setZero();
    const SegmentPair c = closest_line_segment(o, d, b0, b1);
    const double rounding = i % 6 == 2 ? 1e-10 : 1e-13;
    CHECK(violation(c.on_a, c.on_b, {b0, b1}) < rounding);
    CHECK(std::fabs((c.on_b - c.on_a).dot(d)) < 1e-13 * (1 + d.norm()));
    CHECK((c.on_a - o - c.s * d).norm() < 1e-15 * (1 + d.norm()));
    CHECK(c.t >= 0);
    CHECK(c.t <= 1);
    inner += c.t > 0 && c.t < 1;
  }
  if (n > 1000) CHECK(inner > n / 10);
  // Parallel: the first end; no direction: a point.
  CHECK(closest_line_segment(Vec3(0, 1, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(5, 0, 0)).t == 0);
  CHECK(closest_line_segment(Vec3(0, 1, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(5, 0, 0)).s == 1.5);
  CHECK(closest_line_segment(Vec3(4, 1, 0), Vec3::Zero(), Vec3(3, 0, 0), Vec3(5, 0, 0)).t == 0.5);
}

TEST_CASE("crossing segments at a small angle touch") {
  Random random(42);
  for (int i = 0; i < draws::count(20000); ++i) {
    const Vec3 centre = draws::in_box(random, 1), u = draws::direction(random);
    const double angle = std::pow(10.0, random.uniform(-7, 0));
    const Vec3 v = u + angle * draws::direction(random);
    const double s = random.uniform(0.1, 1), t = random.uniform(0.1, 1);
    const SegmentPair c =
        closest_segment_segment(centre - s * u, centre + u, centre - t * v, centre + v);
    CHECK(c.squared_distance < 1e-28);
  }
}

TEST_CASE("closest points of triangles: never further than dense samples, conditions hold") {
  Random random(43);
  int hits = 0;
  const int n = draws::count(20000);
  for (int i = 0; i < n; ++i) {
    auto a = any_triangle(random, i), b = any_triangle(random, i / 6);
    const bool meet = triangles_intersect(a, b);
    hits += meet;
    const TrianglePair c = closest_triangle_triangle(a, b);
    if (meet) CHECK(c.squared_distance < 1e-24);
    // A distance that should be zero is at most rounding.
    if (!meet && c.squared_distance > 1e-20) {
      CHECK(violation(c.on_b, c.on_a, {a[0], a[1], a[2]}) < 1e-10);
      CHECK(violation(c.on_a, c.on_b, {b[0], b[1], b[2]}) < 1e-10);
    }
    const ClosestPair s = closest_segment_triangle(a[0], a[1], b);
    CHECK(s.squared_distance >= c.squared_distance - 1e-14);
    if (segment_triangle_intersect(a[0], a[1], b)) {
      CHECK(s.squared_distance < 1e-24);
    } else if (s.squared_distance > 1e-20) {
      CHECK(violation(s.on_b, s.on_a, {a[0], a[1]}) < 1e-10);
      CHECK(violation(s.on_a, s.on_b, {b[0], b[1], b[2]}) < 1e-10);
    }
  }
  if (n > 1000) CHECK(hits > n / 100);
}

TEST_CASE("projections on plane and line, segment against plane") {
  Random random(44);
  for (int i = 0; i < draws::count(10000); ++i) {
    const auto t = draws::triangle(random);
    const auto plane = plane_through(t[0], t[1], t[2]);
    REQUIRE(plane);
    for (const Vec3& c : t) CHECK(std::fabs(plane->distance(c)) < 1e-14);
    CHECK(plane->distance(t[0] + (t[1] - t[0]).cross(t[2] - t[0])) > 0);
    const Vec3 p = draws::in_box(random, 3), q = draws::in_box(random, 3);
    CHECK(std::fabs(plane->distance(project_on_plane(p, *plane))) < 1e-14);
    CHECK(project_on_plane(p, *plane).isApprox(p - plane->distance(p) * plane->normal));
    const Vec3 foot = project_on_line(p, t[0], t[1] - t[0]);
    CHECK(std::fabs((p - foot).dot(t[1] - t[0])) < 1e-12);
    CHECK((foot - t[0]).cross(t[1] - t[0]).norm() < 1e-12);
    CHECK(std::fabs(reject(p, plane->normal).dot(plane->normal)) < 1e-14);
    const auto s = segment_plane(p, q, *plane);
    CHECK(s.has_value() == ((plane->distance(p) > 0) != (plane->distance(q) > 0)));
    if (s) CHECK(std::fabs(plane->distance(p + *s * (q - p))) < 1e-13);
  }
  CHECK_FALSE(plane_through(Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)));
  CHECK(project_on_line(Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3::Zero()) == Vec3(4, 5, 6));
  const Plane ground;
  CHECK(segment_plane(Vec3(0, 0, 0), Vec3(1, 0, 0), ground).value() == 0);
  CHECK(segment_plane(Vec3(0, 1, 0), Vec3(1, 0, 0), ground).value() == 1);
  CHECK(segment_plane(Vec3(0, 1, 0), Vec3(1, -3, 0), ground).value() == 0.25);
  CHECK_FALSE(segment_plane(Vec3(0, 1, 0), Vec3(1, 2, 0), ground));
}
