// Point and vertex in object. Reference: solids made of unit cubes on a lattice, sheared by integer
// matrices; whether a point of the half lattice is inside, outside or on the border is known from
// the cubes alone, exactly. Rays from there graze edges and vertices all the time. Every kind of
// hierarchy must agree.
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/primitive_tests/box_pairs.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"
#include "tests/geometry/draws.hpp"

#include <limits>
#include <map>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr int cells = 4;

/// A random set of unit cubes in [0, cells]^3.
struct Cubes {
  std::array<bool, cells * cells * cells> filled{};

  Cubes(Random& r, double share) {
    for (bool& f : filled) f = r.uniform() < share;
  }
  bool at(int x, int y, int z) const {
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= cells) return false;
    return filled[size_t((x * cells + y) * cells + z)];
  }
  /// Of a point in half units: all cubes that hold it full, none, or some of either.
  PointSide side(const std::array<int, 3>& half_units) const {
    int full = 0, empty = 0;
    const auto low = [](int h) { return h % 2 == 0 ? h / 2 - 1 : (h - 1) / 2; };
    const auto high = [](int h) { return h % 2 == 0 ? h / 2 : (h - 1) / 2; };
    for (int x = low(half_units[0]); x <= high(half_units[0]); ++x) {
      for (int y = low(half_units[1]); y <= high(half_units[1]); ++y) {
        for (int z = low(half_units[2]); z <= high(half_units[2]); ++z) {
          ++(at(x, y, z) ? full : empty);
        }
      }
    }
    if (empty == 0) return PointSide::inside;
    return full == 0 ? PointSide::outside : PointSide::boundary;
  }
};

/// The border of the cubes, two triangles a face with random diagonals, mapped by `m`.
TriangleMesh border(const Cubes& cubes, const Mat3& m, Random& random) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, uint32_t> ids;
  const auto id = [&](const std::array<int, 3>& p) {
    const auto [it, added] = ids.try_emplace(p, uint32_t(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(m * Vec3(p[0], p[1], p[2]));
    return it->second;
  };
  const bool mirrored = m.determinant() < 0;
  for (int cell = 0; cell < cells * cells * cells; ++cell) {
    const std::array<int, 3> c{cell / (cells * cells), cell / cells % cells, cell % cells};
    if (!cubes.at(c[0], c[1], c[2])) continue;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        std::array<int, 3> beside = c;
        beside[axis] += sign;
        if (cubes.at(beside[0], beside[1], beside[2])) continue;
        std::array<uint32_t, 4> quad;
        for (size_t k = 0; k < 4; ++k) {
          std::array<int, 3> p = c;
          p[axis] += sign > 0;
          p[(axis + 1) % 3] += k == 1 || k == 2;
          p[(axis + 2) % 3] += k >= 2;
          quad[k] = id(p);
        }
        if ((sign < 0) != mirrored) std::swap(quad[1], quad[3]);
        const uint32_t first = random.below(2);
        const auto q = [&](uint32_t k) { return quad[(k + first) % 4]; };
        mesh.triangles.push_back({q(0), q(1), q(2)});
        mesh.triangles.push_back({q(0), q(2), q(3)});
      }
    }
  }
  return mesh;
}

Mat3 shear(Random& r) {
  for (;;) {
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = int(r.below(7)) - 3;
    if (std::fabs(m.determinant()) > 0.5) return m;
  }
}

}  // namespace

TEST_CASE(
    "a point in an object of cubes: inside, outside, on the border, through every hierarchy") {
  Random random(500);
  std::array<int, 3> sides{};
  const int solids = test::only_to_run() ? 4 : test::graded_count(800, 120);
  for (int s = 0; s < solids; ++s) {
    const Cubes cubes(random, 0.1 + 0.8 * random.uniform());
    const double scale = s % 3 ? 1 : 0x1p-20;
    const Mat3 m = scale * (s % 2 ? shear(random) : Mat3(Mat3::Identity()));
    auto mesh = std::make_shared<TriangleMesh>(border(cubes, m, random));
    if (mesh->triangles.empty()) continue;
    const bool inside_out = s % 7 == 0;
    if (inside_out) flip(*mesh);
    std::vector<std::unique_ptr<Hierarchy>> kinds;
    for (const HierarchyKind& kind : all_hierarchies()) kinds.push_back(kind.build(mesh));
    for (int i = 0; i < 125; ++i) {
      std::array<int, 3> h;
      for (int& c : h) c = int(random.below(2 * cells + 3)) - 1;
      const Vec3 p = m * (0.5 * Vec3(h[0], h[1], h[2]));
      const PointSide expected = cubes.side(h);
      ++sides[size_t(expected)];
      for (const auto& kind : kinds) {
        CAPTURE(std::string(kind->name()));
        const PointInObject got = point_in_object(p, *kind);
        REQUIRE(got.side == expected);
        const int winding = expected == PointSide::inside ? (inside_out ? -1 : 1) : 0;
        REQUIRE(got.winding == winding);
        const auto contact = vertex_in_object(p, *kind);
        REQUIRE(contact.has_value() == (expected != PointSide::outside));
        if (!contact) continue;
        REQUIRE(std::fabs(contact->normal.norm() - 1) < 1e-14);
        REQUIRE(
            (contact->on_vertex + contact->depth * contact->normal - contact->on_surface).norm() <
            1e-12 * scale);
        REQUIRE((contact->depth > 0) == (expected == PointSide::inside));
      }
    }
  }
  if (solids > 100) {
    for (const int n : sides) CHECK(n > solids * 125 / 20);
  }
}

TEST_CASE("a point one ulp beside a face, an edge and a vertex of an object") {
  const auto mesh = std::make_shared<const TriangleMesh>(make_mesh::box(Vec3(1, 1, 1)));
  for (const HierarchyKind& kind : all_hierarchies()) {
    const auto object = kind.build(mesh);
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3& start : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(1, -1, 0)}) {
        for (const double sign : {-1.0, 1.0}) {
          Vec3 p = start;
          p[axis] = sign;
          CHECK(point_in_object(p, *object).side == PointSide::boundary);
          p[axis] = std::nextafter(sign, 2 * sign);
          CHECK(point_in_object(p, *object).side == PointSide::outside);
          p = Vec3(0.25, 0.5, -0.125);
          p[axis] = std::nextafter(sign, 0);
          CHECK(point_in_object(p, *object).side == PointSide::inside);
        }
      }
    }
    const auto deep = vertex_in_object(Vec3(0.5, 0.1, 0.2), *object);
    REQUIRE(deep);
    CHECK((deep->normal - Vec3::UnitX()).norm() < 1e-15);
    CHECK(std::fabs(deep->depth - 0.5) < 1e-15);
    const auto surface = vertex_in_object(Vec3(0.5, 0.1, 1), *object);
    REQUIRE(surface);
    CHECK(surface->normal == Vec3::UnitZ());
    CHECK(surface->depth == 0);
    CHECK_FALSE(vertex_in_object(Vec3(1.5, 0, 0), *object));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(point_in_object(Vec3(nan, 0, 0), *object).side == PointSide::outside);
  }
}

TEST_CASE("parts that overlap count as their union, and how often they wind is told") {
  TriangleMesh two = make_mesh::box(Vec3(1, 1, 1)), other = two;
  for (Vec3& v : other.vertices) v += Vec3(1, 0, 0);
  append(two, other);
  for (const HierarchyKind& kind : all_hierarchies()) {
    const auto object = kind.build(std::make_shared<const TriangleMesh>(two));
    CHECK(point_in_object(Vec3(0.5, 0.1, 0), *object).winding == 2);
    CHECK(point_in_object(Vec3(-0.5, 0.1, 0), *object).winding == 1);
    CHECK(point_in_object(Vec3(1.5, 0, 0), *object).winding == 1);
    CHECK(point_in_object(Vec3(2.5, 0, 0), *object).side == PointSide::outside);
  }
}

TEST_CASE("boxes that are segments along X meet triangles as segments do, touching ones too") {
  Random random(12);
  const auto whole = [&] { return std::floor(random.uniform(-2, 3)); };
  const auto corner = [&] { return Vec3(whole(), whole(), whole()); };
  int met = 0, missed = 0;
  for (int i = 0; i < draws::count(20000); ++i) {
    const Triangle3 t{corner(), corner(), corner()};
    const Vec3 from = corner();
    const Vec3 to(from.x() + std::max(0.0, whole()), from.y(), from.z());
    const bool meets = box_triangle_intersect(Aabb{from, to}, t);
    CHECK(meets == segment_triangle_intersect(from, to, t));
    ++(meets ? met : missed);
  }
  CHECK(met > draws::count(20000) / 50);
  CHECK(missed > draws::count(20000) / 50);
}
