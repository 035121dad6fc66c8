// Primitive tests. References: the separating-axis theorem in exact integer arithmetic (another
// algorithm than the one under test, on lattice coordinates), distance by nested ternary search for
// random doubles, and closest points for spheres.
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/predicates/expansion.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using I = long long;
using IVec = Vector3<I>;

/// Whether some axis that could separate two convex sets with these corners and sides does so.
/// All normals, cross products of sides, and their products within planes and along lines are
/// tried, so that sets without area are covered too.
bool separated(const std::vector<IVec>& a, const std::vector<IVec>& b) {
  std::vector<IVec> sides;
  for (const auto* set : {&a, &b}) {
    for (size_t i = 0; i < set->size(); ++i) {
      for (size_t j = i + 1; j < set->size(); ++j) sides.push_back((*set)[j] - (*set)[i]);
    }
  }
  const auto separates = [&](const IVec& axis) {
    I min_a = 1LL << 62, max_a = -min_a, min_b = min_a, max_b = -min_a;
    for (const IVec& p : a) {
      min_a = std::min(min_a, axis.dot(p));
      max_a = std::max(max_a, axis.dot(p));
    }
    for (const IVec& p : b) {
      min_b = std::min(min_b, axis.dot(p));
      max_b = std::max(max_b, axis.dot(p));
    }
    return max_a < min_b || max_b < min_a;
  };
  const IVec d = b[0] - a[0];
  if (separates(d)) return true;
  for (const IVec& u : sides) {
    if (separates(u) || separates(u.cross(d).cross(u))) return true;
    for (const IVec& v : sides) {
      const IVec n = u.cross(v);
      if (separates(n)) return true;
      for (const IVec& w : sides) {
        if (separates(n.cross(w))) return true;
      }
    }
  }
  return false;
}

IVec lattice_point(Random& r, int size) {
  const auto n = uint32_t(2 * size + 1);
  const I x = I(r.below(n)) - size, y = I(r.below(n)) - size, z = I(r.below(n)) - size;
  return {x, y, z};
}

/// Doubles that lose nothing: lattice coordinates times a power of two, moved by a lattice vector.
Vec3 to_double(const IVec& p, double scale, const Vec3& offset) {
  return scale * p.cast<double>() + offset;
}

}  // namespace

TEST_CASE("triangles, segments and points on small lattices: exact against integer separation") {
  // Lattices this small make every second case touch, lie in one plane or have no area.
  for (const int size : {1, 2, 3, 6}) {
    Random random(uint64_t(100 + size));
    int hits = 0, segment_hits = 0, segment_pairs = 0, holds = 0;
    const int n = draws::count(8000);
    for (int i = 0; i < n; ++i) {
      std::vector<IVec> a, b;
      for (int k = 0; k < 3; ++k) {
        a.push_back(lattice_point(random, size));
        b.push_back(lattice_point(random, size));
      }
      const double scale = i % 2 ? 1.0 : 0x1p-20;
      const Vec3 offset = i % 3 ? Vec3::Zero() : scale * Vec3(1048577, -77, 4097);
      const auto at = [&](const IVec& p) { return to_double(p, scale, offset); };
      const std::array<Vec3, 3> ta{at(a[0]), at(a[1]), at(a[2])}, tb{at(b[0]), at(b[1]), at(b[2])};
      const bool meet = !separated(a, b);
      hits += meet;
      REQUIRE(triangles_intersect(ta, tb) == meet);
      REQUIRE(triangles_intersect(tb, ta) == meet);
      REQUIRE(triangles_intersect({ta[1], ta[0], ta[2]}, {tb[2], tb[0], tb[1]}) == meet);

      const bool crossing = !separated({a[0], a[1]}, b);
      segment_hits += crossing;
      REQUIRE(segment_triangle_intersect(ta[0], ta[1], tb) == crossing);
      REQUIRE(segment_triangle_intersect(ta[1], ta[0], tb) == crossing);
      const bool pair = !separated({a[0], a[1]}, {b[0], b[1]});
      segment_pairs += pair;
      REQUIRE(segments_intersect(ta[0], ta[1], tb[0], tb[1]) == pair);
      const bool held = !separated({a[0]}, b);
      holds += held;
      REQUIRE(point_in_triangle(ta[0], tb) == held);
    }
    if (n > 1000) {
      CHECK(hits > n / 10);
      CHECK(hits < n * 9 / 10);
      CHECK(segment_hits > n / 50);
      CHECK(segment_pairs > 0);
      CHECK(holds > 0);
    }
  }
}

TEST_CASE("orientation is exact one ulp beside a plane") {
  Random random(5);
  for (int i = 0; i < draws::count(20000); ++i) {
    // d = a + s (b - a) + t (c - a) with small dyadic s, t is exactly on the plane of a lattice.
    const Vec3 a = lattice_point(random, 1000).cast<double>(),
               b = lattice_point(random, 1000).cast<double>(),
               c = lattice_point(random, 1000).cast<double>();
    const double s = int(random.below(64)) / 32.0 - 1, t = int(random.below(64)) / 32.0 - 1;
    Vec3 d = a + s * (b - a) + t * (c - a);
    CHECK(orientation(a, b, c, d) == 0);
    const Vec3 n = (b - a).cross(c - a);
    int axis = int(random.below(3));
    if (n[axis] == 0 || d[axis] == 0) continue;
    d[axis] = std::nextafter(d[axis], 1e9);
    CHECK(orientation(a, b, c, d) == (n[axis] > 0 ? 1 : -1));
    CHECK(orientation(b, a, c, d) == (n[axis] > 0 ? -1 : 1));
    CHECK(orientation(d, b, c, a) == (n[axis] > 0 ? -1 : 1));
  }
}

TEST_CASE("expansions obey ring identities exactly") {
  Random random(6);
  for (int i = 0; i < draws::count(5000); ++i) {
    const double a = random.uniform(-1, 1), b = random.uniform(-1e8, 1e8),
                 c = random.uniform(-1e-8, 1e-8), d = random.uniform(-1, 1);
    const Expansion ab = Expansion::product(a, b), cd = Expansion::difference(c, d);
    // (ab + cd)(ab - cd) = ab ab - cd cd
    CHECK(((ab + cd) * (ab - cd) - (ab * ab - cd * cd)).sign() == 0);
    const Expansion shifted = ab * ab - cd * cd + Expansion(0x1p-400);
    CHECK((shifted - (ab + cd) * (ab - cd)).sign() == 1);
  }
}

TEST_CASE("box against box and triangle: agrees with sampling, yes for touching") {
  Random random(20);
  int hits = 0;
  const int n = draws::count(4000);
  for (int i = 0; i < n; ++i) {
    OrientedBox a, b;
    a.half_axes = draws::rotation(random).toRotationMatrix() * Vec3(0.5, 0.3, 0.2).asDiagonal();
    b.half_axes = draws::rotation(random).toRotationMatrix() * Vec3(0.6, 0.2, 0.1).asDiagonal();
    b.centre = draws::in_box(random, 0.8);
    const bool meet = boxes_intersect(a, b);
    CHECK(boxes_intersect(b, a) == meet);
    hits += meet;
    // Distance by alternating projection between two convex sets (von Neumann 1933).
    const auto project = [](const OrientedBox& box, const Vec3& p) {
      Vec3 out = box.centre;
      for (int k = 0; k < 3; ++k) {
        const Vec3 h = box.half_axes.col(k);
        out += std::clamp(h.dot(p - box.centre) / h.squaredNorm(), -1.0, 1.0) * h;
      }
      return out;
    };
    Vec3 p = b.centre;
    double gap = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 on_a = project(a, p);
      p = project(b, on_a);
      gap = (p - on_a).norm();
      if (gap == 0) break;
    }
    if (meet) CHECK(gap < 1e-2);
    if (!meet) CHECK(gap > 0);
    if (gap > 1e-2) CHECK_FALSE(meet);
  }
  if (n > 1000) {
    CHECK(hits > n * 3 / 10);
    CHECK(hits < n * 7 / 10);
  }
  OrientedBox unit, beside;
  beside.centre = Vec3(2, 0.5, 0.5);
  CHECK(boxes_intersect(unit, beside));  // touching faces
  beside.centre = Vec3(2, 2, 2);
  CHECK(boxes_intersect(unit, beside));  // touching corners
  beside.centre.x() = std::nextafter(2.0, 3.0);
  CHECK_FALSE(boxes_intersect(unit, beside));
  beside.half_axes.setZero();  // a point
  beside.centre = Vec3(1, 1, 1);
  CHECK(boxes_intersect(unit, beside));
  beside.centre = Vec3(1, 1, 1.001);
  CHECK_FALSE(boxes_intersect(unit, beside));
}

TEST_CASE("aligned box against triangle and segment: exact on lattices") {
  for (const int size : {2, 4}) {
    Random random(uint64_t(30 + size));
    int hits = 0;
    const int n = draws::count(8000);
    for (int i = 0; i < n; ++i) {
      std::vector<IVec> t{lattice_point(random, size), lattice_point(random, size),
                          lattice_point(random, size)};
      IVec low = lattice_point(random, size), high = lattice_point(random, size);
      const IVec min = low.cwiseMin(high), max = low.cwiseMax(high);
      std::vector<IVec> corners;
      for (int k = 0; k < 8; ++k) {
        corners.emplace_back(k & 1 ? min.x() : max.x(), k & 2 ? min.y() : max.y(),
                             k & 4 ? min.z() : max.z());
      }
      const Aabb box{min.cast<double>(), max.cast<double>()};
      const std::array<Vec3, 3> td{t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>()};
      // Integer separation needs only sides of the box: corners joined by any diagonal do no harm.
      const bool meet = !separated(t, corners);
      hits += meet;
      REQUIRE(box_triangle_intersect(box, td) == meet);
      REQUIRE(segment_box_intersect(td[0], td[1], box) == !separated({t[0], t[1]}, corners));
      const Vec3 c = td[2];
      const double d2 = (c - c.cwiseMax(box.min).cwiseMin(box.max)).squaredNorm();
      REQUIRE(sphere_box_intersect(c, 2, box) == (d2 <= 4));
    }
    if (n > 1000) {
      CHECK(hits > n * 2 / 10);
      CHECK(hits < n * 8 / 10);
    }
  }
}
