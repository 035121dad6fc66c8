// References: closed forms for balls and capsules; for polyhedra the separating-axis distance by
// brute force over all face normals and edge cross products; for every pair the contact's own
// definition (points between the two surfaces, symmetry under exchange).
#include "engine/collision/convex_pairs/capsule_box.hpp"
#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "tests/collision/pair_run.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

/// Two convex shapes at random poses near each other, `n` times.
void check_convex_pair(Random& r, const std::shared_ptr<const Shape>& a,
                       const std::shared_ptr<const Shape>& b, int n) {
  CAPTURE(a->words());
  CAPTURE(b->words());
  const double margin = 0.02;
  int touching = 0;
  for (int i = 0; i < n; ++i) {
    const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
    const Pose pb{pa.x + random_direction(r) * r.uniform(0, 1.6), random_rotation(r)};
    const auto list = run(*a, pa, *b, pb, margin);
    const auto swapped = run(*b, pb, *a, pa, margin);
    REQUIRE(list.size() == swapped.size());
    if (list.empty()) continue;
    ++touching;
    REQUIRE(list.size() == 1);
    const Manifold &m = list[0], &s = swapped[0];
    CHECK(std::abs(m.normal.norm() - 1) < 1e-12);
    const auto curved = [](const Shape& s) {
      return s.convex()->view().kind == CoreView::Kind::general;
    };
    const bool smooth = curved(*a) || curved(*b);
    CHECK(least_gap(list) == doctest::Approx(least_gap(swapped)).epsilon(smooth ? 5e-3 : 1e-6));
    if (a->type() != b->type()) CHECK((m.normal + s.normal).norm() < 1e-6);
    REQUIRE(m.count >= 1);
    // no direction separates by less than the depth that is claimed, but for the tolerance by
    // which faces win over edges
    const double along = -(reach(*a->convex(), pa, m.normal) + reach(*b->convex(), pb, -m.normal));
    CHECK(least_gap(list) >= along - 1e-6);
    for (int k = 0; k < 30; ++k) {
      const Vec3 d = random_direction(r);
      const double other = -(reach(*a->convex(), pa, d) + reach(*b->convex(), pb, -d));
      CHECK(std::min(0.0, other) <=
            std::max(0.0, least_gap(list)) + 1e-9 + (least_gap(list) < 0 ? 0 : margin));
      if (least_gap(list) < 0) CHECK(other <= along * (along < 0 ? 0.94 : 1.0) + 1e-3);
    }
    for (int k = 0; k < m.count; ++k)
      for (int l = 0; l < k; ++l) CHECK(m.points[size_t(k)].feature != m.points[size_t(l)].feature);
  }
  if (n >= 100) CHECK((touching > 0.2 * n && touching <= n));
}

/// Whether every contact point is midway between the surfaces: no farther from either shape than
/// half its gap, by the shape's bounds in eight turned frames.
bool points_on_shapes(const std::vector<Manifold>& list, const Shape& s, const Pose& pose) {
  Random turns(11);
  for (int k = 0; k < 8; ++k) {
    const Pose frame{Vec3::Zero(), random_rotation(turns)};
    const Aabb bounds = s.bounds(frame * pose);
    for (const Manifold& m : list)
      for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[size_t(i)];
        const double slack = 0.51 * std::abs(p.gap) + 1e-3 * s.bounding_radius();
        if (!bounds.inflated(slack).contains(frame.point(p.x_world))) return false;
      }
  }
  return true;
}

}  // namespace

TEST_CASE("two balls meet as the distance of their centres says") {
  Random r(1);
  int touching = 0;
  const int n = cases(2000);
  for (int i = 0; i < n; ++i) {
    const double ra = r.uniform(0.1, 1), rb = r.uniform(0.1, 1);
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    const Pose pb{random_vec(r, -1, 1), random_rotation(r)};
    const auto list = run(*sphere(ra), pa, *sphere(rb), pb, 0.05);
    const double gap = (pb.x - pa.x).norm() - ra - rb;
    REQUIRE(list.empty() == (gap > 0.05));
    if (list.empty()) continue;
    ++touching;
    CHECK(list[0].points[0].gap == doctest::Approx(gap));
    CHECK((list[0].normal - (pb.x - pa.x).normalized()).norm() < 1e-9);
  }
  if (n >= 100) CHECK((touching > 0.2 * n && touching < 0.8 * n));
}

TEST_CASE("a segment is nearest to a box where samples say, and no way along it leads nearer") {
  // Oblique, along faces and edges, through the box, and of no length.
  Random r(31);
  const int n = cases(4000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const Vec3 h = random_vec(r, 0.05, 1);
    Vec3 p0 = random_vec(r, -2, 2), p1 = random_vec(r, -2, 2);
    if (i % 4 == 1) p1[i % 3] = p0[i % 3];
    if (i % 4 == 2) p1 = p0 + r.uniform(-2, 2) * Vec3::Unit(i % 3);
    if (i % 16 == 3) p1 = p0;
    const SegmentBoxDistance found = nearest_segment_box(p0, p1, h);
    const auto away = [&](double t) -> Vec3 {
      const Vec3 p = p0 + t * (p1 - p0);
      return p - p.cwiseMax(-h).cwiseMin(h);
    };
    REQUIRE((found.t >= 0 && found.t <= 1));
    CHECK((found.between - away(found.t)).norm() < 1e-14);
    double least = 1e9;
    for (int k = 0; k <= 400; ++k) least = std::min(least, away(k / 400.0).norm());
    CHECK(found.between.norm() <= least + 1e-14);
    CHECK(found.between.norm() >= least - (p1 - p0).norm() / 800);
    const double slope = (p1 - p0).dot(found.between);
    if (found.t > 0) CHECK(slope <= 1e-13);
    if (found.t < 1) CHECK(slope >= -1e-13);
  }
}

TEST_CASE("capsules meet boxes as any two convex shapes do") {
  Random r(32);
  int touching = 0;
  const int n = cases(4000);
  for (int i = 0; i < n; ++i) {
    CAPTURE(i);
    const auto a = capsule(r.uniform(0.05, 0.4), r.uniform(0.1, 1.5));
    const auto b = box(random_vec(r, 0.1, 1));
    const Pose pb{random_vec(r, -1, 1), random_rotation(r)};
    Pose pa{random_vec(r, -1.6, 1.6), random_rotation(r)};
    if (i % 5 == 0) pa.q = pb.q;  // along an edge
    const double margin = 0.1;
    for (const bool swapped : {false, true}) {
      const Shape &first = swapped ? *b : *a, &second = swapped ? *a : *b;
      const Pose &at_first = swapped ? pb : pa, &at_second = swapped ? pa : pb;
      const auto found = run(first, at_first, second, at_second, margin);
      std::vector<Manifold> reference;
      collide_convex_convex(ShapePair(first, at_first, second, at_second, {margin}), reference);
      REQUIRE(found.empty() == reference.empty());
      if (found.empty()) continue;
      ++touching;
      CHECK(std::abs(least_gap(found) - least_gap(reference)) < 1e-9);
      CHECK((found[0].normal - reference[0].normal).norm() < 1e-6);
    }
  }
  if (n >= 100) CHECK((touching > n / 5 && touching < 2 * n - n / 5));
}

TEST_CASE("every convex pair: exchange, bounds of depth, unit normals, points between surfaces") {
  Random r(3), turned(603);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      sphere(0.5),        capsule(0.3, 0.8),          box({0.3, 0.4, 0.5}),
      cylinder(0.4, 0.7), ellipsoid({0.5, 0.3, 0.2}), random_hull(r, 20, {0.5, 0.6, 0.4})};
  const int n = cases(400);
  for (const auto& a : shapes)
    for (const auto& b : shapes) check_convex_pair(r, a, b, n);
  // Whatever else is listed, with the others and with itself.
  for (const auto& a : every_solid()) {
    if (a->convex()->view().kind != CoreView::Kind::general) continue;
    for (const auto& b : every_solid()) check_convex_pair(turned, a, b, n);
    check_convex_pair(turned, a, shapes.back(), n);
  }
}

TEST_CASE("shapes that just touch do so where they are") {
  Random r(29);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.2),
                                                         capsule(0.14, 0.3),
                                                         box({0.19, 0.19, 0.19}),
                                                         cylinder(0.17, 0.36),
                                                         cylinder(0.4, 0.01),
                                                         ellipsoid({0.25, 0.15, 0.1}),
                                                         cone(0.2, 0.4),
                                                         cone(0.3, 0.05),
                                                         tapered_capsule(0.2, 0.08, 0.3),
                                                         tapered_capsule(0.05, 0.2, 0.16),
                                                         random_hull(r, 20, {0.5, 0.6, 0.4}),
                                                         random_hull(r, 4, {0.2, 0.2, 0.2})};
  const int n = cases(200);
  for (const auto& a : shapes)
    for (const auto& b : shapes)
      for (int i = 0; i < n; ++i) {
        const Pose pa{random_vec(r, -2, 2), random_rotation(r)};
        Pose pb{pa.x + 3 * random_direction(r), random_rotation(r)};
        const auto apart = run(*a, pa, *b, pb, 5);
        REQUIRE(!apart.empty());
        pb.x -= (least_gap(apart) + std::pow(10.0, r.uniform(-12, -2))) * apart[0].normal;
        const auto list = run(*a, pa, *b, pb, 0.02);
        REQUIRE(!list.empty());
        CHECK(points_on_shapes(list, *a, pa));
        CHECK(points_on_shapes(list, *b, pb));
      }
}

TEST_CASE("two rims that cross by 26 micrometres") {
  // the nearest face of the Minkowski difference is a sliver here
  const auto a = cylinder(0x1.5c28f5c28f5c3p-3, 0x1.70a3d70a3d70ap-2), b = a;
  const Pose pa{{-0x1.6161f5f65e6cp+0, 0x1.7b0b4f11e955ep-1, -0x1.cf4c86112e18ap-1},
                Quat(0x1.8171a32cc8e9bp-1, -0x1.a467ee2d2ce35p-3, -0x1.aee1e5f963f7ep-2,
                     0x1.d9c67bc0c81a4p-2)};
  const Pose pb{
      {-0x1.3d580d413f9c5p+0, 0x1.13e9e2ee6819bp+0, -0x1.688db8a6ad07p-1},
      Quat(0x1.679ccfda6401ep-2, 0x1.a5a07658adb2bp-2, 0x1.600f316f70725p-1, 0x1.efaf13248d718p-2)};
  const auto list = run(*a, pa, *b, pb, 0.02);
  REQUIRE(!list.empty());
  CHECK(points_on_shapes(list, *a, pa));
  CHECK(points_on_shapes(list, *b, pb));
}

TEST_CASE(
    "hulls of any size: bounds from every vertex, the face most nearly across from all planes") {
  Random r(23);
  for (const int n : {4, 6, 12, 24, 40, 80, 300})
    for (int i = 0; i < cases(20); ++i) {
      const auto shape = random_hull(r, n, {0.4, 0.5, 0.3});
      const ConvexPolyhedron& p = static_cast<const ConvexHullShape&>(*shape).polyhedron();
      const Pose pose{random_vec(r, -3, 3), random_rotation(r)};
      Aabb all;
      for (const Vec3& v : p.vertices) all.include(pose.point(v));
      const Aabb bounds = shape->bounds(pose);
      CHECK((bounds.min - all.min).norm() < 1e-14);
      CHECK((bounds.max - all.max).norm() < 1e-14);

      const Vec3 d = random_direction(r);
      double best = -1;
      for (const Plane& plane : p.planes) best = std::max(best, plane.normal.dot(d));
      SupportingFace face;
      shape->convex()->supporting_face(d, face);
      REQUIRE(face.count >= 3);
      const Vec3 normal =
          (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]).normalized();
      CHECK(normal.dot(d) == doctest::Approx(best).epsilon(1e-9));
    }
}

TEST_CASE("a cylinder stands on its cap and lies on its side") {
  const auto floor = half_space(), slab = box({5, 1, 5}), can = cylinder(0.5, 1);
  for (const auto& ground : {floor, slab}) {
    const Pose below{{0, ground == slab ? -1.0 : 0.0, 0}, Quat::Identity()};
    auto list = run(*ground, below, *can, {{0, 0.499, 0}, Quat::Identity()}, 0.02);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 4);
    CHECK((list[0].normal - Vec3::UnitY()).norm() < 1e-9);
    list = run(*ground, below, *can, {{0, 0.499, 0}, axis_angle(Vec3::UnitX(), det::pi / 2)}, 0.02);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
  }
}

TEST_CASE(
    "a cone stands on its base, lies on its side, stands on its tip, a tapered capsule lies") {
  const double lean = det::asin(1 / std::sqrt(10.0));  // of the side, for height 3 radius
  const auto floor = half_space(), slab = box({5, 1, 5}), spike = cone(0.2, 0.6);
  const auto bone = tapered_capsule(0.3, 0.1, 0.5);
  for (const auto& ground : {floor, slab}) {
    const Pose below{{0, ground == slab ? -1.0 : 0.0, 0}, Quat::Identity()};
    const auto on = [&](const Shape& s, double height, double tilt) {
      return run(*ground, below, s, {{0, height, 0}, axis_angle(Vec3::UnitZ(), tilt)}, 0.02);
    };
    auto list = on(*spike, 0.299, 0);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 4);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
    // The middle of the axis is half the height from the tip, whose line lies on the ground.
    list = on(*spike, 0.3 / std::sqrt(10.0) - 0.001, det::pi / 2 + lean);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(list[0].points[0].gap == doctest::Approx(-0.001));
    CHECK(list[0].points[1].gap == doctest::Approx(-0.001));
    CHECK((list[0].points[0].x_world - list[0].points[1].x_world).norm() ==
          doctest::Approx(0.2 * std::sqrt(10.0)).epsilon(0.01));
    list = on(*spike, 0.299, det::pi);
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 1);
    CHECK(least_gap(list) == doctest::Approx(-0.001));
    // Both ends of the bone touch where its axis leans by (r0 - r1) / height.
    list = on(*bone, 0.2 - 0.001, det::pi / 2 + det::asin(0.4));
    REQUIRE(list.size() == 1);
    CHECK(list[0].count == 2);
    CHECK(list[0].points[0].gap == doctest::Approx(-0.001));
    CHECK(list[0].points[1].gap == doctest::Approx(-0.001));
  }
}

TEST_CASE("far from the origin contacts keep their digits") {
  const auto a = box({1, 0.5, 1}), b = box({0.5, 0.5, 0.5});
  const Vec3 far(1e5, -3e4, 2e5);
  const auto list =
      run(*a, {far, Quat::Identity()}, *b, {far + Vec3(0.2, 0.99, -0.1), Quat::Identity()}, 0.02);
  REQUIRE(list.size() == 1);
  CHECK(list[0].points[0].gap == doctest::Approx(-0.01).epsilon(1e-6));
}

TEST_CASE("poses that are not finite give no contacts") {
  const auto a = box({1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(run(*a, {}, *a, {{nan, 0, 0}, Quat::Identity()}, 0.1).empty());
  CHECK(run(*a, {}, *sphere(1), {{0, 0, 0}, Quat(nan, 0, 0, 0)}, 0.1).empty());
}

TEST_CASE("coincident shapes have a defined contact") {
  Random r(5);
  std::vector<std::shared_ptr<const Shape>> shapes = every_solid();
  shapes.push_back(random_hull(r, 20, {0.5, 0.6, 0.4}));
  for (const auto& a : shapes)
    for (const auto& b : shapes) {
      const Pose p{{1, 2, 3}, random_rotation(r)};
      const auto list = run(*a, p, *b, p, 0.01);
      REQUIRE(list.size() == 1);
      CHECK(std::abs(list[0].normal.norm() - 1) < 1e-9);
      CHECK(list[0].points[0].x_world.allFinite());
      CHECK(least_gap(list) < -0.1);
    }
}
