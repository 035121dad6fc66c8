// Convex hulls beside Qhull 2020.2: the same corners and volume where points are in general
// position; where they are not, Qhull merges facets and its volume may be off by percents (a unit
// cube with repeated corners: 0.917), so that families with a closed form are compared with that.
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "tests/geometry/hull_families.hpp"
#include "tests/geometry/qhull_peer.hpp"
#include "tests/support/scale.hpp"

#include <cstdlib>

#include <doctest/doctest.h>

using namespace tumble;
using hull_families::Points;

namespace {

enum class Where { ball, sphere, cube };

Points draw(Random& r, Where where, int n) {
  return hull_families::repeat(uint32_t(n), [&]() -> Vec3 {
    if (where == Where::cube) return draws::in_box(r, 1);
    const Vec3 d = draws::direction(r);
    return where == Where::sphere ? d : Vec3(d * std::cbrt(r.uniform()));
  });
}

/// Closed, convex at every edge, linear in the faces (check_hull also tries points).
void check_surface(const ConvexPolyhedron& p, double epsilon) {
  CHECK(p.vertices.size() + p.face_count() == p.edges.size() + 2);
  size_t concave = 0, loose = 0;
  for (uint32_t h = 0; h < p.face_vertices.size(); ++h) {
    const uint32_t twin = p.half_edge_twin[h];
    loose += p.half_edge_twin[twin] != h || p.face_vertices[twin] != p.face_vertices[p.next(h)];
    const Plane& across = p.planes[p.half_edge_face[twin]];
    for (uint32_t v : p.face(p.half_edge_face[h]))
      concave += across.distance(p.vertices[v]) > epsilon;
  }
  CHECK(loose == 0);
  CHECK(concave == 0);
}

void compare(const Points& points, bool whole_check) {
  const auto ours = convex_hull(points, {1e-13});
  REQUIRE(ours.ok());
  const auto theirs = peers::qhull(points);
  REQUIRE(theirs.ok);
  CHECK(ours->source == theirs.vertices);
  CHECK(polyhedron_mass(ours->polyhedron).mass == doctest::Approx(theirs.volume).epsilon(1e-9));
  check_surface(ours->polyhedron, ours->tolerance);
  if (whole_check) CHECK(check_hull(ours->polyhedron, points, ours->tolerance).ok());
}

}  // namespace

TEST_CASE("small hulls have Qhull's corners and volume") {
  Random random(31);
  for (int i = 0; i < draws::count(300); ++i) {
    const auto where = std::array{Where::ball, Where::sphere, Where::cube}[random.below(3)];
    Points points = draw(random, where, 5 + int(random.below(300)));
    if (i % 2) {
      const Quat q = draws::rotation(random);
      const Vec3 shape(1, random.uniform(0.01, 1), random.uniform(0.01, 1));
      for (Vec3& p : points) p = q * p.cwiseProduct(shape);
    }
    compare(points, true);
  }
}

TEST_CASE("hulls of very many points have Qhull's corners and volume") {
  Random random(32);
  compare(draw(random, Where::ball, test::graded_count(1000000, 100000)), true);
  compare(draw(random, Where::cube, test::graded_count(1000000, 100000)), true);
}

TEST_CASE("hulls of very many points on a sphere: no corner of Qhull's is missing") {
  // At distances of 1e-11 between a corner and its neighbours' planes, Qhull leaves out a few.
  Random random(34);
  const Points points = draw(random, Where::sphere, test::graded_count(200000, 20000));
  const auto ours = convex_hull(points, {1e-14});
  REQUIRE(ours.ok());
  check_surface(ours->polyhedron, ours->tolerance);
  CHECK(ours->source.size() > points.size() - points.size() / 100000 - 1);
  const auto theirs = peers::qhull(points);
  REQUIRE(theirs.ok);
  CHECK(std::includes(ours->source.begin(), ours->source.end(), theirs.vertices.begin(),
                      theirs.vertices.end()));
  CHECK(polyhedron_mass(ours->polyhedron).mass == doctest::Approx(theirs.volume).epsilon(1e-9));

  const Points many = draw(random, Where::sphere, test::graded_count(1000000, 20000));
  const auto large = convex_hull(many, {1e-14});
  REQUIRE(large.ok());
  check_surface(large->polyhedron, large->tolerance);
  CHECK(large->source.size() > many.size() - many.size() / 10000 - 1);
}

TEST_CASE("degenerate families: Qhull's corners are ours, the volume is the closed form's") {
  Random random(33);
  for (int i = 0; i < draws::count(200); ++i) {
    // A lattice, its points in random order and repeated.
    const uint32_t m = 2 + random.below(6);
    Points points = {{0, 0, 0}};
    for (int corner = 1; corner < 8; ++corner) {
      points.emplace_back(corner & 1 ? m : 0, corner & 2 ? m : 0, corner & 4 ? m : 0);
    }
    for (int k = 0; k < 200; ++k) {
      points.emplace_back(random.below(m + 1), random.below(m + 1), random.below(m + 1));
    }
    for (size_t k = points.size(); k-- > 1;) {
      std::swap(points[k], points[random.below(uint32_t(k + 1))]);
    }
    const auto hull = convex_hull(points, {});
    REQUIRE(hull.ok());
    CHECK(hull->polyhedron.face_count() == 6);
    CHECK(polyhedron_mass(hull->polyhedron).mass == doctest::Approx(m * m * m).epsilon(1e-12));
    std::vector<Vec3> theirs;
    for (uint32_t v : peers::qhull(points).vertices) theirs.push_back(points[v]);
    for (const Vec3& v : hull->polyhedron.vertices) {
      CHECK(std::find(theirs.begin(), theirs.end(), v) != theirs.end());
    }
  }
}
