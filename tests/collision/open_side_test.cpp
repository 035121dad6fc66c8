// Which side of an open mesh a shape is on. Reference: plain geometry; every shape here is placed
// on one side by construction, apart from the mesh or overlapping it a little.
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

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

/// What has this outline, counter-clockwise in x and y and 0.2 m long in z, with these triangles at
/// its ends.
TriangleMesh prism(std::span<const Vec2> outline, std::span<const Triangle> ends) {
  TriangleMesh out;
  const auto n = uint32_t(outline.size());
  for (const double z : {-0.1, 0.1})
    for (const Vec2& p : outline) out.vertices.emplace_back(p.x(), p.y(), z);
  for (const Triangle& t : ends) {
    out.triangles.push_back({t[0], t[2], t[1]});
    out.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t j = (i + 1) % n;
    out.triangles.push_back({i, j, j + n});
    out.triangles.push_back({i, j + n, i + n});
  }
  REQUIRE(check_solid(out).faults.empty());
  return out;
}

/// The least and the greatest y of the contact normals, which point from a to b; and how many
/// contacts there are below a height.
struct Upwards {
  double least = 1, greatest = -1;
  double nearest = 1e9;  ///< least gap [m]
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
      out.nearest = std::min(out.nearest, m.points[size_t(i)].gap);
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

TEST_CASE("a clamp about the rim of a sheet touches it with the tips of both jaws") {
  const auto sheet = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  // Its jaws end in tips .008 m apart, elsewhere they are .06 m apart; the rim is at x = 2.
  constexpr double h = 0.004;
  constexpr uint32_t corners = 10;
  const std::array<Vec2, corners> outline{
      Vec2(1.8, -0.1),  Vec2(2.2, -0.1), Vec2(2.2, 0.1),   Vec2(1.8, 0.1),    Vec2(1.8, h),
      Vec2(1.85, 0.03), Vec2(2.1, 0.03), Vec2(2.1, -0.03), Vec2(1.85, -0.03), Vec2(1.8, -h)};
  const auto grip =
      mesh(prism(outline, std::array{Triangle{0, 1, 7}, Triangle{0, 7, 8}, Triangle{0, 8, 9},
                                     Triangle{1, 2, 6}, Triangle{1, 6, 7}, Triangle{3, 4, 5},
                                     Triangle{2, 3, 5}, Triangle{2, 5, 6}}));
  for (const double up : {0.0, 0.002, -0.002}) {
    CAPTURE(up);
    const Upwards found = upwards(*grip, {{0, up, 0}}, *sheet);
    CHECK(found.greatest > 0.5);
    CHECK(found.least < -0.5);
    CHECK(found.nearest == doctest::Approx(h - std::fabs(up)));
  }
}

TEST_CASE("a flat jaw of a clamp that comes through the sheet is held on its side of it") {
  const auto sheet = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  // The jaws are .008 m apart; the rim is at x = 2.
  constexpr double h = 0.004;
  constexpr uint32_t corners = 8;
  const std::array<Vec2, corners> outline{Vec2(1.8, -0.1), Vec2(2.2, -0.1), Vec2(2.2, 0.1),
                                          Vec2(1.8, 0.1),  Vec2(1.8, h),    Vec2(2.1, h),
                                          Vec2(2.1, -h),   Vec2(1.8, -h)};
  const auto grip =
      mesh(prism(outline, std::array{Triangle{0, 1, 6}, Triangle{0, 6, 7}, Triangle{1, 2, 5},
                                     Triangle{1, 5, 6}, Triangle{2, 3, 5}, Triangle{3, 4, 5}}));
  for (const double way : {1.0, -1.0}) {
    CAPTURE(way);
    std::vector<Manifold> found;
    ContactQuery query(0.01);
    ClosestFeatures kept;
    for (const double through : {-h, 1e-4, 5e-4}) {
      CAPTURE(through);
      found.clear();
      collide(*grip, {{0, way * (h + through), 0}, Quat::Identity()}, *sheet, {}, query, found);
      double least = 1e9, up = 0;
      for (const Manifold& m : found)
        for (int i = 0; i < m.count; ++i)
          if (m.points[size_t(i)].gap < least) {
            least = m.points[size_t(i)].gap;
            up = m.normal.y();
          }
      REQUIRE_FALSE(found.empty());
      if (through > 0) {
        CHECK(least <= -through + 1e-9);
        CHECK(up * way > 0.5);
      } else {
        CHECK(least == doctest::Approx(-through));
      }
      kept = found.front().closest;
      query.start = &kept;
    }
  }
}

TEST_CASE("what comes to a sheet from beside its rim lies where most of it then is") {
  const auto sheet = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  // Its ridge is at the origin; the rim is at x = 2, in the plane of which the ridge comes.
  const std::array<Vec2, 3> outline{Vec2(0, 0), Vec2(0, -0.2), Vec2(0.2, -0.2)};
  const std::array<Triangle, 1> end{Triangle{0, 1, 2}};
  const auto wedge = mesh(prism(outline, end));
  for (const double way : {1.0, -1.0}) {
    CAPTURE(way);
    // Turned about the x axis, it comes from above.
    const Quat turn = way > 0 ? Quat::Identity() : axis_angle(Vec3::UnitX(), std::numbers::pi);
    std::vector<Manifold> found;
    ContactQuery query(0.01);
    collide(*wedge, {{2.005, -1e-6 * way, 0}, turn}, *sheet, {}, query, found);
    REQUIRE_FALSE(found.empty());
    const ClosestFeatures kept = found.front().closest;
    query.start = &kept;
    found.clear();
    collide(*wedge, {{1.93, 1e-4 * way, 0}, turn}, *sheet, {}, query, found);
    REQUIRE_FALSE(found.empty());
    for (const Manifold& m : found) CHECK(m.normal.y() * way > 0.5);
  }
}

TEST_CASE("a torus half through a sheet lies where it came from") {
  const auto sheet = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  const auto torus = mesh(make_mesh::torus(0.3, 0.1, 16, 8));
  for (const double from : {1.0, -1.0}) {
    CAPTURE(from);
    std::vector<Manifold> found;
    ContactQuery query(0.01);
    ClosestFeatures kept;
    // The torus is 0.1 m high to either side.
    for (const double height : {0.105, 0.09, 0.03, 0.0, -0.02}) {
      CAPTURE(height);
      found.clear();
      collide(*torus, {{0.07, from * height, 0.03}, Quat::Identity()}, *sheet, {}, query, found);
      REQUIRE_FALSE(found.empty());
      for (const Manifold& m : found) CHECK(m.normal.y() * from < -0.5);
      kept = found.front().closest;
      query.start = &kept;
    }
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
