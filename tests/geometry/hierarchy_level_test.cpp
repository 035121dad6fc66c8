// The volumes of a level, as drawn and as measured. References: every corner of every triangle by
// the definition of a volume (distance from the hull of its points, by nearest points of hulls);
// ends of wires at exactly the radius from that hull; counts by walking a tree of known shape;
// volumes and surfaces by closed forms, and by counting grid points for a rounded hull (5e-3).
#include "engine/geometry/hierarchy/hull_separation.hpp"
#include "engine/geometry/hierarchy/level.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double pi_ = std::numbers::pi;

double outside(const NodeBound& bound, const Vec3& p) {
  return hull_distance({&p, 1}, bound.points).lower - bound.radius;
}

/// Keeps what is drawn.
struct LevelRecorder final : DebugDraw {
  struct Line {
    Vec3 a, b;
    Vec4f colour;
  };
  std::vector<Line> lines;
  void line(const Vec3& a, const Vec3& b, const Vec4f& c) override { lines.push_back({a, b, c}); }
  void point(const Vec3&, const Vec4f&, float) override {}
  void text(const Vec3&, const Vec4f&, std::string_view) override {}
};

NodeBound hull_bound(std::vector<Vec3> points, double radius) {
  NodeBound b;
  b.form = BoundForm::hull;
  b.points = std::move(points);
  b.radius = radius;
  return b;
}

std::vector<Vec3> cube_corners(double edge) {
  std::vector<Vec3> out;
  for (int k = 0; k < 8; ++k) out.push_back(edge * Vec3(k & 1, (k >> 1) & 1, k >> 2));
  return out;
}

}  // namespace

TEST_CASE("each level holds every triangle once, within the volumes that are drawn") {
  for (const auto& [family, mesh] : hard_meshes::families()) {
    for (const HierarchyKind& kind : all_hierarchies()) {
      if (kind.name == "brute_force") continue;
      const std::string what = std::string(family) + ", " + std::string(kind.name);
      CAPTURE(what);
      const auto tree = kind.build(mesh);
      const double size = tree->bounds().extent().norm();
      // Coordinates far from the origin are rounded to 1e-16 of themselves.
      const double slack = 1e-6 * size + 1e-15 * mesh->vertices[0].norm();
      size_t before = 0;
      for (int level : {0, 1, 2, 3, 4, tree->depth() / 2 + 2, tree->depth() + 3}) {
        const auto bounds = level_bounds(*tree, level);
        CHECK(bounds.size() >= before);
        CHECK(bounds.size() <= (size_t{1} << std::min(level, 40)));
        before = bounds.size();
        std::vector<uint32_t> held;
        double worst = -1;
        for (const NodeBound& b : bounds) {
          CHECK((b.level == level || (b.leaf && b.level < level)));
          for (uint32_t t : b.triangles) {
            held.push_back(t);
            for (size_t c = 0; c < 3; ++c) worst = std::max(worst, outside(b, mesh->corner(t, c)));
          }
        }
        CHECK(worst <= slack);
        REQUIRE(held.size() == mesh->triangles.size());
        std::sort(held.begin(), held.end());
        for (uint32_t t = 0; t < held.size(); ++t) CHECK(held[t] == t);
      }
      CHECK(measure_room(*tree).nodes == tree->node_count());
      CHECK(measure_room(*tree).leaves == before);
      CHECK(2 * before == tree->node_count() + 1);
    }
  }
}

TEST_CASE("a level of 2^n equal parts has 2^n volumes, brute force has none") {
  TriangleMesh row;  // 64 groups of four triangles, far apart
  for (int i = 0; i < 64; ++i) {
    const double x = 10.0 * i;
    const auto n = uint32_t(row.vertices.size());
    for (const Vec3& v : {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x, 1, 0), Vec3(x, 0, 1)})
      row.vertices.push_back(v);
    for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
      row.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  const auto mesh = hard_meshes::share(std::move(row));
  for (const HierarchyKind& kind : all_hierarchies()) {
    const std::string name(kind.name);
    CAPTURE(name);
    const auto tree = kind.build(mesh, {TreeBuilder::longest_axis});
    const bool none = kind.name == "brute_force";
    for (int level = 0; level <= 6; ++level)
      CHECK(level_bounds(*tree, level).size() == (none ? 0 : size_t{1} << level));
    CHECK(level_bounds(*tree, -3).size() == (none ? 0 : 1));
    LevelRecorder drawn;
    draw_level(*tree, 2, {}, drawn);
    const size_t each = kind.name == "sphere" ? 3 * 48 : 12;
    if (kind.name != "convex_hull") CHECK(drawn.lines.size() == (none ? 0 : 4 * each));
    std::set<std::array<float, 3>> colours;
    for (const auto& l : drawn.lines) colours.insert({l.colour[0], l.colour[1], l.colour[2]});
    CHECK(colours.size() == (none ? 0 : 4));
  }
}

TEST_CASE("wires lie on the surface of their volumes, where the pose puts them") {
  Random r(71);
  const Pose pose{Vec3(3, -2, 5), draws::rotation(r)};
  for (const auto& [family, mesh] : hard_meshes::families()) {
    for (const HierarchyKind& kind : all_hierarchies()) {
      const std::string what = std::string(family) + ", " + std::string(kind.name);
      CAPTURE(what);
      const auto tree = kind.build(mesh);
      const double size = tree->bounds().extent().norm();
      const double slack = 1e-7 * size + 1e-14 * (10 + mesh->vertices[0].norm());
      for (const NodeBound& b : level_bounds(*tree, 2)) {
        LevelRecorder drawn;
        draw_bound(b, pose, node_colour(*tree, b), drawn);
        CHECK(!drawn.lines.empty());
        for (const auto& l : drawn.lines) {
          const Vec3 p = pose.inverse_point(l.a);
          CHECK(std::fabs(outside(b, p)) <= slack);
          CHECK(outside(b, pose.inverse_point(0.5 * (l.a + l.b))) <= slack);
          // On the surface: some direction leads out of the volume at once.
          double out = -1;
          for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
            for (const double s : {-1.0, 1.0})
              out = std::max(out, outside(b, p + s * 1e-3 * (size + 1e-9) * d));
          if (size > 0) CHECK(out > 0);
        }
      }
    }
  }
}

TEST_CASE("rounded hulls reach no farther than their outermost vertex") {
  const auto mesh = hard_meshes::share(make_mesh::torus(1, 0.4, 24, 16));
  for (const HierarchyKind& kind : all_hierarchies()) {
    if (kind.name != "convex_hull") continue;
    const auto tree = kind.build(mesh);
    for (const int level : {0, 1, 2, 4}) {
      for (const NodeBound& b : level_bounds(*tree, level)) {
        double needed = 0;
        for (uint32_t t : b.triangles)
          for (size_t c = 0; c < 3; ++c) {
            const Vec3 p = mesh->corner(t, c);
            needed = std::max(needed, hull_distance({&p, 1}, b.points).upper);
          }
        CHECK(b.radius <= needed * (1 + 1e-6) + 1e-12);
      }
    }
    CHECK(measure_room(*tree).root_volume < 1.3 * measure(hull_bound(mesh->vertices, 0)).volume);
  }
}

TEST_CASE("measures: boxes, spheres, rounded cubes, plates and needles by closed forms") {
  NodeBound box;
  set_box(box, Vec3(4, 5, 6), Vec3(0.5, 1, 1.5).asDiagonal());
  CHECK(measure(box).volume == doctest::Approx(6).epsilon(1e-14));
  CHECK(measure(box).surface == doctest::Approx(22).epsilon(1e-14));
  NodeBound sphere;
  sphere.form = BoundForm::sphere;
  sphere.points = {Vec3(1, 2, 3)};
  sphere.radius = 0.5;
  CHECK(measure(sphere).volume == doctest::Approx(pi_ / 6).epsilon(1e-14));
  CHECK(measure(sphere).surface == doctest::Approx(pi_).epsilon(1e-14));

  const auto check = [](const NodeBound& b, double volume, double surface) {
    CHECK(measure(b).volume == doctest::Approx(volume).epsilon(1e-12));
    CHECK(measure(b).surface == doctest::Approx(surface).epsilon(1e-12));
  };
  const double r = 0.25;
  check(hull_bound(cube_corners(2), 0), 8, 24);
  check(hull_bound(cube_corners(2), r), 8 + 24 * r + 6 * pi_ * r * r + 4 * pi_ / 3 * r * r * r,
        24 + 12 * pi_ * r + 4 * pi_ * r * r);
  // A square plate of side 2 with its middle and a midpoint of a side, turned.
  Random random(72);
  const Quat q = draws::rotation(random);
  std::vector<Vec3> plate;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0), Vec3(1, 1, 0),
                        Vec3(1, 0, 0), Vec3(2, 0, 0)})
    plate.push_back(q * p);
  check(hull_bound(plate, 0), 0, 8);
  check(hull_bound(plate, r), 8 * r + 4 * pi_ * r * r + 4 * pi_ / 3 * r * r * r,
        8 + 8 * pi_ * r + 4 * pi_ * r * r);
  const auto needle = hull_bound({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3)}, r);
  const double l = std::sqrt(27);
  check(needle, pi_ * r * r * l + 4 * pi_ / 3 * r * r * r, 2 * pi_ * r * l + 4 * pi_ * r * r);
  check(hull_bound({Vec3(1, 1, 1), Vec3(1, 1, 1)}, r), 4 * pi_ / 3 * r * r * r, 4 * pi_ * r * r);
}

TEST_CASE("the volume of a rounded hull is the share of points within its radius") {
  Random r(73);
  const std::vector<Vec3> points = draws::points(r, 12);
  const NodeBound b = hull_bound(points, 0.3);
  const double side = 3.2;
  constexpr int n = 50;
  size_t inside = 0;
  for (int k = 0; k < n * n * n; ++k) {
    const Vec3 cell(k % n, (k / n) % n, k / (n * n));
    const Vec3 p = side * ((cell + Vec3::Constant(0.5)) / n - Vec3::Constant(0.5));
    if (outside(b, p) <= 0) ++inside;
  }
  const double counted = double(inside) * std::pow(side / n, 3);
  CHECK(measure(b).volume == doctest::Approx(counted).epsilon(5e-3));
}

TEST_CASE("lines through a tree: random lines meet as many volumes as the measure says") {
  const auto mesh = hard_meshes::share(make_mesh::torus(1, 0.4, 12, 8));
  const auto tree = all_hierarchies()[2].build(mesh);
  REQUIRE(tree->name() == "sphere");
  std::vector<NodeBound> all;
  tree->visit_nodes([&](const NodeBound& b) {
    all.push_back(b);
    return true;
  });
  // Lines with uniform directions and offsets meet a convex body in proportion to its surface.
  Random r(74);
  const double reach = all[0].radius;
  size_t lines = 0, met = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 d = draws::direction(r);
    Vec3 u, v;
    tangent_frame(d, u, v);
    // Children of spheres may stand out from their parents.
    const Vec3 at = draws::in_box(r, 1.5 * reach);
    const Vec3 through = all[0].points[0] + at.x() * u + at.y() * v;
    const auto meets = [&](const NodeBound& b) {
      const Vec3 m = b.points[0] - through;
      return (m - d * d.dot(m)).norm() <= b.radius;
    };
    lines += meets(all[0]);
    for (const NodeBound& b : all) met += meets(b);
  }
  CHECK(lines > 10000);
  CHECK(double(met) / double(lines) ==
        doctest::Approx(measure_room(*tree).nodes_per_line).epsilon(0.03));
}
