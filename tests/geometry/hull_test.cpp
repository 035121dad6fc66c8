// Convex hull. References: check_hull's own definition (every point inside every plane), brute
// force O(n^4) over all triples of points, closed-form facet counts and volumes of solids.
#include "engine/core/random.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/support/why_not.hpp"

#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Points that are corners of the exact hull, by trying every triple: a triple whose plane has all
/// points on one side holds (at least) its extreme corners.
std::set<uint32_t> brute_force_corners(const std::vector<Vec3>& p) {
  std::set<uint32_t> out;
  const auto n = uint32_t(p.size());
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = i + 1; j < n; ++j) {
      for (uint32_t k = j + 1; k < n; ++k) {
        bool above = false, below = false;
        for (uint32_t m = 0; m < n && !(above && below); ++m) {
          const int s = orientation(p[i], p[j], p[k], p[m]);
          above = above || s > 0;
          below = below || s < 0;
        }
        if (above != below) out.insert({i, j, k});
      }
    }
  }
  return out;
}

void check(const std::vector<Vec3>& points, const HullOptions& options = {}) {
  const auto hull = convex_hull(points, options);
  REQUIRE_MESSAGE(hull.ok(), test::why_not(hull));
  const Status valid = check_hull(hull->polyhedron, points, hull->tolerance);
  CHECK_MESSAGE(valid.ok(), test::why_not(valid));
  for (size_t v = 0; v < hull->source.size(); ++v) {
    CHECK(points[hull->source[v]] == hull->polyhedron.vertices[v]);
  }
}

}  // namespace

TEST_CASE("hull of random points has the corners that brute force finds") {
  Random random(7);
  for (int i = 0; i < draws::count(200); ++i) {
    const auto points = draws::points(random, 4 + random.below(20));
    const auto hull = convex_hull(points, {});
    REQUIRE(hull.ok());
    const std::set<uint32_t> corners(hull->source.begin(), hull->source.end());
    CHECK(corners == brute_force_corners(points));
    check(points);
  }
}

TEST_CASE("hull of a box with points on its faces, edges and corners is the box") {
  Random random(8);
  for (int i = 0; i < draws::count(100); ++i) {
    const Pose pose{draws::in_box(random, 5), draws::rotation(random)};
    const Vec3 half{random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
    std::vector<Vec3> points = make_mesh::box(half).vertices;
    for (int k = 0; k < 300; ++k) {
      Vec3 p = half.cwiseProduct(draws::in_box(random, 1));
      const int fixed = 1 + int(random.below(3));
      for (int f = 0; f < fixed; ++f) {
        const int axis = int(random.below(3));
        p[axis] = (random.below(2) ? 1 : -1) * half[axis];
      }
      points.push_back(p);
    }
    if (i % 2) {
      for (Vec3& p : points) p = pose.point(p);
    }
    check(points);
    const auto hull = convex_hull(points, {});
    CHECK(hull->polyhedron.vertices.size() == 8);
    CHECK(hull->polyhedron.face_count() == 6);
    CHECK(hull->polyhedron.edges.size() == 12);
    const double volume = 8 * half.x() * half.y() * half.z();
    CHECK(polyhedron_mass(hull->polyhedron).mass == doctest::Approx(volume).epsilon(1e-7));
  }
}

TEST_CASE("hull of a fine cylinder keeps its round facets and merges its ends") {
  const TriangleMesh mesh = make_mesh::cylinder(1, 0.5, 200);
  check(mesh.vertices);
  const auto hull = convex_hull(mesh.vertices, {});
  CHECK(hull->polyhedron.face_count() == 202);
  CHECK(hull->polyhedron.vertices.size() == 400);
}

TEST_CASE("hull of an icosphere is itself") {
  const TriangleMesh mesh = make_mesh::icosphere(2, 4);
  check(mesh.vertices);
  const auto hull = convex_hull(mesh.vertices, {});
  CHECK(hull->polyhedron.vertices.size() == mesh.vertices.size());
  CHECK(hull->polyhedron.face_count() == mesh.triangles.size());
  CHECK(polyhedron_mass(hull->polyhedron).mass ==
        doctest::Approx(mesh_integrals(mesh).mass).epsilon(1e-12));
}

TEST_CASE("degenerate families of points: duplicates, lattice, needle, slab, far away, noise") {
  Random random(9);
  std::vector<Vec3> lattice;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      for (int z = 0; z < 6; ++z) lattice.emplace_back(x, y, z);
    }
  }
  SUBCASE("lattice, twice") {
    lattice.insert(lattice.end(), lattice.begin(), lattice.end());
    check(lattice);
    CHECK(convex_hull(lattice, {})->polyhedron.vertices.size() == 8);
  }
  SUBCASE("turned lattice") {
    const Quat q = draws::rotation(random);
    for (Vec3& p : lattice) p = q * p;
    check(lattice);
    CHECK(convex_hull(lattice, {})->polyhedron.vertices.size() == 8);
  }
  SUBCASE("needle and slab") {
    for (const Vec3& shape : {Vec3(1e3, 1e-3, 1e-3), Vec3(1e3, 1e3, 1e-3), Vec3(1, 1e-4, 1e-8)}) {
      for (int i = 0; i < 20; ++i) {
        auto points = draws::points(random, 200);
        for (Vec3& p : points) p = p.cwiseProduct(shape);
        check(points);
      }
    }
  }
  SUBCASE("far from the origin") {
    auto points = draws::points(random, 300);
    for (Vec3& p : points) p += Vec3(1e6, -2e6, 3e6);
    check(points);
  }
  SUBCASE("noise near the tolerance") {
    for (const double noise : {1e-16, 1e-12, 1e-10, 1e-9, 3e-9, 1e-8, 1e-7}) {
      const Quat q = draws::rotation(random);
      auto points = draws::points(random, 500);
      for (Vec3& p : points) {
        int axis;
        p.cwiseAbs().maxCoeff(&axis);
        p[axis] = (p[axis] > 0 ? 1 : -1) + noise * random.uniform(-1, 1);
        p = q * p;
      }
      check(points);
      check(points, {1e-6});
    }
  }
  SUBCASE("stored in single precision") {
    auto points = make_mesh::cylinder(1, 0.5, 64).vertices;
    const Quat q = draws::rotation(random);
    for (Vec3& p : points) p = (q * p).cast<float>().cast<double>();
    check(points, {1e-6});
    CHECK(convex_hull(points, {1e-6})->polyhedron.face_count() == 66);
  }
}

TEST_CASE("hull of 1e5 points, in a ball and on a sphere") {
  Random random(10);
  std::vector<Vec3> ball, sphere;
  for (int i = 0; i < 100000; ++i) {
    sphere.push_back(draws::direction(random));
    ball.push_back(sphere.back() * std::cbrt(random.uniform()));
  }
  const auto inner = convex_hull(ball, {});
  REQUIRE(inner.ok());
  CHECK(check_hull(inner->polyhedron, ball, inner->tolerance).ok());
  const auto outer = convex_hull(sphere, {});
  REQUIRE(outer.ok());
  CHECK(outer->polyhedron.vertices.size() > 99900);
  CHECK(outer->polyhedron.vertices.size() + outer->polyhedron.face_count() ==
        outer->polyhedron.edges.size() + 2);
}

TEST_CASE("points without volume are refused with the reason") {
  Random random(11);
  const auto refused = [](const std::vector<Vec3>& points, const char* why) {
    const auto hull = convex_hull(points, {});
    REQUIRE_FALSE(hull.ok());
    CHECK_MESSAGE(hull.error().message.find(why) != std::string::npos, hull.error().text());
  };
  const Quat q = draws::rotation(random);
  std::vector<Vec3> same(100, Vec3(1, 2, 3)), line, plane;
  for (int i = 0; i < 100; ++i) {
    line.push_back(q * Vec3(random.uniform(), 0, 0));
    plane.push_back(q * Vec3{random.uniform(), random.uniform(), 0});
  }
  refused({}, "at least 4");
  refused({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, "at least 4");
  refused(same, "coincide");
  refused(line, "collinear");
  refused(plane, "flat");
  plane.push_back(Vec3(NAN, 0, 0));
  refused(plane, "not finite");
}

TEST_CASE("climbing finds the support that looking at all vertices finds") {
  Random random(12);
  const auto hull = convex_hull(draws::points(random, 500), {});
  REQUIRE(hull.ok());
  uint32_t start = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d = draws::direction(random);
    start = support_vertex_from(hull->polyhedron, d, start);
    CHECK(start == support_vertex(hull->polyhedron, d));
  }
}
