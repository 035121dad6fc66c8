// The gap of meshes with anything, piece by piece. References: over all triangles, without trees,
// the distance of a ball's centre; of touching and overlapping triangles the separating axis
// theorem in extended precision.
#include "engine/dynamics/event/pieces.hpp"

#include "engine/core/random.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

using Long3 = Vector3<long double>;
using Corners = std::array<Long3, 3>;

int cases(int count) {
  return test::scaled_count(count, count / 20);
}

Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (d.norm() < 1 && d.norm() > 0.1) return d.normalized();
  }
}

Quat rotation(Random& random) {
  const Vec3 axis = direction(random);
  return axis_angle(axis, random.uniform(0, 3));
}

std::shared_ptr<const Shape> made(const ShapeDef& def) {
  auto shape = make_shape(def);
  REQUIRE(shape.ok());
  return *shape;
}

TriangleMesh one_triangle(Random& random, double flatness) {
  TriangleMesh m;
  for (int k = 0; k < 3; ++k)
    m.vertices.push_back(
        Vec3(random.uniform(-1, 1), flatness * random.uniform(-1, 1), random.uniform(-1, 1)));
  m.triangles.push_back({0, 1, 2});
  return m;
}

Corners placed(const TriangleMesh& m, const Pose& at, uint32_t t = 0) {
  Corners c;
  const Quaternion<long double> q = at.q.cast<long double>().normalized();
  for (size_t k = 0; k < 3; ++k)
    c[k] = q * m.corner(t, k).cast<long double>() + at.x.cast<long double>();
  return c;
}

long double separation(const Corners& a, const Corners& b, const Long3& n) {
  const auto high = [&](const Corners& c, const Long3& d) {
    return std::max({d.dot(c[0]), d.dot(c[1]), d.dot(c[2])});
  };
  return -high(b, -n) - high(a, n);
}

/// Greatest separation of two triangles by the axes on which it can be attained while they touch or
/// overlap: normals of both, across two sides, and in the planes across one side.
long double separating_axes(const Corners& a, const Corners& b) {
  long double best = -std::numeric_limits<long double>::infinity();
  const auto consider = [&](const Long3& n) {
    if (!(n.norm() > 1e-12L)) return;
    best = std::max({best, separation(a, b, n.normalized()), separation(a, b, -n.normalized())});
  };
  const auto side = [](const Corners& c, size_t k) { return Long3(c[(k + 1) % 3] - c[k]); };
  const Long3 na = side(a, 0).cross(side(a, 1)), nb = side(b, 0).cross(side(b, 1));
  consider(na);
  consider(nb);
  for (size_t i = 0; i < 3; ++i) {
    consider(na.cross(side(a, i)));
    consider(nb.cross(side(b, i)));
    for (size_t j = 0; j < 3; ++j) consider(side(a, i).cross(side(b, j)));
  }
  return best;
}

}  // namespace

TEST_CASE("pieces: a ball's least gap to a mesh is that of all triangles, in and out") {
  Random random(5);
  const TriangleMesh torus = make_mesh::torus(0.5, 0.2, 24, 12);
  const auto mesh = made(test::mesh(torus));
  int near = 0, touching = 0;
  for (int i = 0; i < cases(2000); ++i) {
    const double radius = random.uniform(0.01, 0.3);
    const auto ball = made(sphere(radius));
    const Pose at{direction(random) * random.uniform(0, 0.9), rotation(random)};
    const Pose place{Vec3(direction(random) * 3), rotation(random)};
    const NearestPieces found = nearest_pieces(*ball, place * at, *mesh, place, 0.1, nullptr);
    double want = std::numeric_limits<double>::infinity();
    for (uint32_t t = 0; t < torus.triangles.size(); ++t) {
      const TrianglePoint p =
          closest_on_triangle(at.x, torus.corner(t, 0), torus.corner(t, 1), torus.corner(t, 2));
      want = std::min(want, std::sqrt(p.squared_distance) - radius);
    }
    CHECK(found.gap.near == (want <= 0.1));
    if (!found.gap.near) continue;
    ++near;
    touching += want < 0;
    CHECK(std::fabs(found.gap.gap - want) < 1e-12);
    CHECK(std::fabs(
              piece_separation(*ball, place * at, *mesh, place, found.pieces, found.gap.normal) -
              want) < 1e-12);
  }
  CHECK(near > cases(2000) / 4);
  CHECK(touching > cases(2000) / 20);
}

TEST_CASE("pieces: the least gap of boxes and meshes to a mesh is that of all pairs of triangles") {
  Random random(6);
  const TriangleMesh torus = make_mesh::torus(0.5, 0.2, 16, 8);
  const auto ring = made(test::mesh(torus));
  int near = 0;
  for (int i = 0; i < cases(600); ++i) {
    // Cubes, walls and rods, as boxes and as meshes.
    const Vec3 size(random.uniform(0.1, i % 3 == 0 ? 4 : 0.3),
                    random.uniform(0.02, i % 3 == 1 ? 4 : 0.3), random.uniform(0.1, 0.3));
    const TriangleMesh sides = make_mesh::box(size);
    const auto other = i % 2 ? made(box(size.x(), size.y(), size.z())) : made(test::mesh(sides));
    const Pose at{direction(random) * random.uniform(0.6, 1.8), rotation(random)};
    const Pose place{Vec3(direction(random) * 3), rotation(random)};
    double want = std::numeric_limits<double>::infinity();
    for (uint32_t t = 0; t < torus.triangles.size(); ++t)
      for (uint32_t u = 0; u < sides.triangles.size(); ++u) {
        const std::array<Vec3, 3> p{torus.corner(t, 0), torus.corner(t, 1), torus.corner(t, 2)};
        const std::array<Vec3, 3> q{at.point(sides.corner(u, 0)), at.point(sides.corner(u, 1)),
                                    at.point(sides.corner(u, 2))};
        want = std::min(want, std::sqrt(closest_triangle_triangle(p, q).squared_distance));
      }
    if (want == 0) continue;
    const double margin = i % 5 == 0 ? 0.02 : 0.5;
    const NearestPieces found = nearest_pieces(*ring, place, *other, place * at, margin, nullptr);
    CAPTURE(i);
    CHECK(found.gap.near == (want <= margin));
    if (!found.gap.near) continue;
    ++near;
    CHECK(std::fabs(found.gap.gap - want) < 1e-10);
    CHECK(std::fabs((found.gap.on_b - found.gap.on_a).norm() - want) < 1e-9);
  }
  CHECK(near > cases(600) / 4);
}

TEST_CASE("pieces: two triangles that overlap or touch part as the separating axes say") {
  Random random(6);
  int cut = 0;
  const int count = cases(4000);
  for (int i = 0; i < count; ++i) {
    // Every fourth pair lies nearly or wholly in one plane; every eighth is exactly coplanar.
    const double flatness = i % 4 ? 1 : (i % 8 ? 1e-9 : 0);
    const TriangleMesh ma = one_triangle(random, flatness), mb = one_triangle(random, flatness);
    const auto a = made(mesh(ma)), b = made(mesh(mb));
    Pose pa, pb;
    pb.x = 0.3 * direction(random);
    if (i % 4 == 0) pb.x.y() *= flatness;
    if (i % 4) pb.q = rotation(random), pa.q = rotation(random);
    long double want = separating_axes(placed(ma, pa), placed(mb, pb));
    const PairGap g = piece_gap(*a, pa, *b, pb, {0, 0}, 10, Vec3::Zero());
    REQUIRE(g.near);
    CHECK(double(separation(placed(ma, pa), placed(mb, pb), g.normal.cast<long double>())) ==
          doctest::Approx(g.gap).scale(1).epsilon(1e-12));
    if (want >= 0) {
      CHECK(g.gap >= double(want) - 1e-12);  // corners may be farther than any axis says
    } else {
      ++cut;
      CHECK(g.gap == doctest::Approx(double(want)).scale(1).epsilon(1e-9));
    }
  }
  CHECK(cut > count / 10);
  CHECK(cut < count * 9 / 10);
}

TEST_CASE("pieces: an open sheet pushes back what came through, on either side") {
  TriangleMesh sheet;
  sheet.vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
  const auto open = made(mesh(sheet));
  const auto rod = made(capsule(0.01, 0.3));
  for (const double side : {1.0, -1.0}) {
    const Pose at{Vec3(0.1, side * (0.01 - 1e-8), 0.05),
                  axis_angle(Vec3::UnitZ(), 1.5707963267948966)};
    const NearestPieces n = nearest_pieces(*rod, at, *open, Pose{}, 0.1, nullptr);
    CHECK(n.gap.gap == doctest::Approx(-1e-8).epsilon(1e-4));
    CHECK((n.gap.normal - Vec3(0, -side, 0)).norm() < 1e-9);
  }
}
