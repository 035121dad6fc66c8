// Which side of an open mesh a shape is on. Reference: plain geometry; every shape here is placed
// on one side by construction, apart from the mesh or overlapping it a little.
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A box of 1 m without a lid, whose normals point into it.
TriangleMesh container() {
  TriangleMesh out = make_mesh::box({0.5, 0.5, 0.5});
  flip(out);
  std::erase_if(out.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](uint32_t v) { return out.vertices[v].y() > 0.4; });
  });
  return out;
}

/// The least and the greatest y of the contact normals, which point from a to b; and how many
/// contacts there are below a height.
struct Upwards {
  double least = 1, greatest = -1;
  int count = 0;
};
Upwards upwards(const Shape& a, const Pose& at, const Shape& b, double height = 1e9) {
  std::vector<Manifold> found;
  collide(a, at, b, {}, 0.01, found);
  Upwards out;
  for (const Manifold& m : found)
    for (int i = 0; i < m.count; ++i) {
      if (m.points[size_t(i)].x_world.y() > height) continue;
      ++out.count;
      out.least = std::min(out.least, m.normal.y());
      out.greatest = std::max(out.greatest, m.normal.y());
    }
  return out;
}

}  // namespace

TEST_CASE("a tyre that lies over a bump of one-sided terrain is in front of it") {
  const auto bump = [](double x, double z) {
    return std::max(0.0, 0.4 * (1 - (x * x + z * z) / 0.09));
  };
  const auto ground = mesh(make_mesh::terrain(4, 40, bump));
  const TriangleMesh torus = make_mesh::torus(0.6, 0.15, 16, 8);
  const auto tyre = mesh(torus);
  for (const double gap : {1e-3, -1e-3}) {
    CAPTURE(gap);
    const Upwards found = upwards(*tyre, {{0, gap - bounds(torus).min.y(), 0}}, *ground);
    CHECK(found.count > 0);
    CHECK(found.greatest < -0.5);
  }
}

TEST_CASE("a box that lacks a triangle stands on the floor of a room of triangles") {
  TriangleMesh walls = make_mesh::box({2, 2, 2});
  flip(walls);
  TriangleMesh torn = make_mesh::box({0.2, 0.2, 0.2});
  const auto top = std::ranges::find_if(torn.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](uint32_t v) { return torn.vertices[v].y() > 0; });
  });
  REQUIRE(top != torn.triangles.end());
  torn.triangles.erase(top);
  const auto room = mesh(walls), solid = mesh(torn);
  for (const double gap : {1e-3, -1e-3}) {
    CAPTURE(gap);
    const Upwards found = upwards(*solid, {{0.3, -1.8 + gap, 0.2}}, *room);
    CHECK(found.count > 0);
    CHECK(found.greatest < -0.5);
  }
}

TEST_CASE("a plank that leans over the rim of an open container stands on its bottom") {
  const auto open = mesh(container());
  const auto plank = box({1.6, 0.02, 0.2});
  const Vec3 along = Vec3(0.9, 1, 0).normalized(), out(-along.y(), along.x(), 0);
  for (const double gap : {1e-3, -1e-3}) {
    CAPTURE(gap);
    Pose at{Vec3(-0.4, -0.5 + gap, 0) + 1.6 * along + 0.02 * out,
            axis_angle(Vec3::UnitZ(), std::atan2(1, 0.9))};
    REQUIRE(at.x.x() > 0.5);  // its centre is outside
    const Upwards found = upwards(*plank, at, *open, -0.4);
    CHECK(found.count > 0);
    CHECK(found.greatest < -0.5);
  }
}

TEST_CASE("a plate that overlaps one-sided terrain by half its thickness is in front of it") {
  const auto ground = mesh(make_mesh::terrain(4, 20, [](double, double) { return 0.0; }));
  const auto plate = box({0.1, 0.001, 0.1});
  for (const double y : {0.0015, 0.0005, 1e-4, -1e-4}) {
    CAPTURE(y);
    const Upwards found = upwards(*plate, {{0.03, y, 0.02}}, *ground);
    CHECK(found.count > 0);
    CHECK(found.greatest < -0.5);
  }
}

TEST_CASE("a box behind one-sided terrain is held there, overlapping or not") {
  const auto ground = mesh(make_mesh::terrain(4, 20, [](double, double) { return 0.0; }));
  const auto cube = box({0.1, 0.1, 0.1});
  for (const double gap : {1e-3, -1e-3}) {
    CAPTURE(gap);
    const Upwards found = upwards(*cube, {{0.03, -0.1 - gap, 0.02}}, *ground);
    CHECK(found.count > 0);
    CHECK(found.least > 0.5);
  }
}

TEST_CASE("an open surface seen from behind has its normals reversed, and ridges for valleys") {
  const auto ground =
      mesh(make_mesh::terrain(4, 8, [](double x, double z) { return x * x - z * z; }));
  const MeshSurface &front = ground->polyhedral()->surface(),
                    &back = ground->polyhedral()->reversed();
  const auto &f = front.topology, &b = back.topology;
  REQUIRE(f.edges.size() == b.edges.size());
  int ridges = 0, valleys = 0;
  for (size_t e = 0; e < f.edges.size(); ++e) {
    CHECK(f.edges[e].vertices == b.edges[e].vertices);
    CHECK((f.edges[e].normal + b.edges[e].normal).norm() < 1e-12);
    const EdgeBend bend = f.edges[e].bend;
    ridges += bend == EdgeBend::convex, valleys += bend == EdgeBend::concave;
    CHECK((b.edges[e].bend == EdgeBend::convex) == (bend == EdgeBend::concave));
    CHECK((b.edges[e].bend == EdgeBend::open) == (bend == EdgeBend::open));
  }
  CHECK(ridges > 0);
  CHECK(valleys > 0);
}
