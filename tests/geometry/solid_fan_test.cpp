// Many triangles around one vertex or one side. References: all pairs by brute force, decided by
// whether a side of one, without its shared end, meets the other; solids known to be sound.
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"
#include "engine/geometry/solid/self_intersection.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// More in common than shared corners. Coordinates are whole numbers of at most 4, so that no
/// common point beyond a shared end is nearer to it than 1/4096 of the side.
bool clash_by_sides(const Triangle3& s, const Triangle3& t) {
  const auto shared = [](const Vec3& p, const Triangle3& c) {
    return p == c[0] || p == c[1] || p == c[2];
  };
  const auto number =
      std::count_if(s.begin(), s.end(), [&](const Vec3& p) { return shared(p, t); });
  if (number == 0) return triangles_intersect(s, t);
  if (number == 3) return true;
  const auto pierces = [&](const Triangle3& from, const Triangle3& into) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 &p = from[k], &q = from[(k + 1) % 3];
      if (shared(p, into) && shared(q, into)) continue;
      const Vec3 step = (q - p) / 4096;
      if (segment_triangle_intersect(shared(p, into) ? Vec3(p + step) : p,
                                     shared(q, into) ? Vec3(q - step) : q, into)) {
        return true;
      }
    }
    return false;
  };
  return pierces(s, t) || pierces(t, s);
}

/// `fans` tips with `pages` triangles each, in which lattice points are drawn; half of the pages
/// hang at a side that they share.
TriangleMesh lattice_fans(Random& random, uint32_t fans, int pages, bool planar) {
  TriangleMesh m;
  for (uint32_t i = 0; i < 150; ++i) {
    Vec3 p;
    do {
      p = Vec3(double(random.below(9)), double(random.below(9)), double(random.below(9))) -
          Vec3::Constant(4);
      if (planar) p.x() = 0;
    } while (std::find(m.vertices.begin(), m.vertices.end(), p) != m.vertices.end() ||
             (planar && m.vertices.size() >= 81));
    m.vertices.push_back(p);
    if (planar && m.vertices.size() == 81) break;
  }
  const auto n = uint32_t(m.vertices.size());
  for (uint32_t tip = 0; tip < fans; ++tip) {
    for (int k = 0; k < pages; ++k) {
      const uint32_t second = random.below(2) == 0 ? fans + tip : uint32_t(random.below(n));
      Triangle t{tip, second, uint32_t(random.below(n))};
      if (random.below(2) == 0) std::swap(t[0], t[1]);
      if (collinear(m.vertices[t[0]], m.vertices[t[1]], m.vertices[t[2]])) continue;
      m.triangles.push_back(t);
    }
  }
  return m;
}

TriangleMesh cone(uint32_t n, double height, bool base, const Quat& turn) {
  TriangleMesh m;
  m.vertices = {turn * Vec3(0, 0, height), turn * Vec3(0, 0, 0)};
  for (uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    m.vertices.push_back(turn * Vec3(std::cos(angle), std::sin(angle), 0));
    const uint32_t a = 2 + i, b = 2 + (i + 1) % n;
    m.triangles.push_back({0, a, b});
    if (base) m.triangles.push_back({1, b, a});
  }
  return m;
}

}  // namespace

TEST_CASE("clashes in lattice fans, loose and bound at one side, against all pairs") {
  Random random(311);
  size_t clashes = 0, none = 0;
  struct Kind {
    uint32_t fans;
    int pages;
    bool planar;
  };
  for (const Kind kind : {Kind{1, 60, false}, {1, 60, true}, {3, 90, false}, {2, 280, false}}) {
    for (int i = 0; i < std::max(1, draws::count(3)); ++i) {
      const TriangleMesh m = lattice_fans(random, kind.fans, kind.pages, kind.planar);
      std::vector<TriangleIds> expected, found;
      for (uint32_t a = 0; a < m.triangles.size(); ++a) {
        for (uint32_t b = a + 1; b < m.triangles.size(); ++b) {
          if (clash_by_sides(corners(m, a), corners(m, b))) expected.push_back({a, b});
        }
      }
      std::vector<uint32_t> crowded;
      for (const TriangleClash& c : self_intersections(m, &crowded)) {
        found.push_back(c.ids);
        CHECK(c.relation == triangle_relation(corners(m, c.ids.a), corners(m, c.ids.b)));
      }
      CHECK(crowded.empty());
      CHECK(found == expected);
      clashes += expected.size();
      none += m.triangles.size() * (m.triangles.size() - 1) / 2 - expected.size();
    }
  }
  CHECK(clashes > 1000);
  CHECK(none > 1000);
}

TEST_CASE("cones of twenty thousand slivers are sound, discs only open") {
  const auto n = uint32_t(std::max(300, draws::count(20000)));
  const Quat turned = Quat(0.3, 0.5, -0.2, 0.7).normalized();
  CHECK(check_solid(cone(n, 1, true, turned)).text() == "");
  for (const double height : {1e-3, 1e3}) {
    CAPTURE(height);
    CHECK(check_solid(cone(n / 4, height, true, turned)).text() == "");
  }
  CHECK(check_solid(make_mesh::cylinder(0.1, 1, int(n))).text() == "");
  // In a plane across the first axis, along which every box is the same.
  const Quat across(axis_angle(Vec3::UnitY(), 0.5 * std::numbers::pi));
  for (const Quat& q : {across, turned}) {
    const SolidReport r = check_solid(cone(n, 0, false, q));
    REQUIRE(r.faults.size() == 1);
    CHECK(r.faults[0].kind == SolidFaultKind::open_border);
    CHECK(r.faults[0].count == n);
  }
}

TEST_CASE("a book of twenty thousand pages is no solid, but no page cuts another") {
  const auto n = uint32_t(std::max(300, draws::count(20000)));
  TriangleMesh book;
  book.vertices = {Vec3(0, 0, 0), Vec3(0, 0, 1)};
  for (uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    book.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.5);
    book.triangles.push_back({0, 1, 2 + i});
  }
  CHECK(self_intersections(book).empty());
  // A page upon another, and the same one again.
  const uint32_t middle = n / 2;
  book.vertices.push_back(Vec3(0.5, 0.5, 1).cwiseProduct(book.vertices[2 + middle]));
  book.triangles.push_back({0, 1, 2 + n});
  book.triangles.push_back({1, 0, 2 + middle});
  const auto found = self_intersections(book);
  REQUIRE(found.size() == 3);
  CHECK(found[0].ids == TriangleIds{middle, n});
  CHECK(found[1].ids == TriangleIds{middle, n + 1});
  CHECK(found[2].ids == TriangleIds{n, n + 1});
  const SolidReport r = check_solid(book);
  REQUIRE(r.find(SolidFaultKind::non_manifold_edge));
  CHECK(r.find(SolidFaultKind::non_manifold_edge)->count == 1);
}
