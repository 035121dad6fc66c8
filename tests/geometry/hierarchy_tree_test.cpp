// The trees themselves. Reference: every vertex of every triangle against the volumes of all nodes
// above it, by definitions written out here in double (rounding 2e-6 of the mesh for kinds whose
// volumes are turned, else 1e-14); minimal spheres against a slow search that only moves the
// centre (1e-7), boxes against the best of many random rotations.
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/fit_box.hpp"
#include "engine/geometry/hierarchy/hull_tree.hpp"
#include "engine/geometry/hierarchy/minimal_sphere.hpp"
#include "engine/geometry/hierarchy/obb_tree.hpp"
#include "engine/geometry/hierarchy/sphere_tree.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>
#include <functional>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using namespace tumble::hard_meshes;

/// How far p (mesh frame) is outside of a node's volume.
double outside(const AabbTree& tree, const AabbTree::Node& n, const Vec3& p) {
  const Vec3 q = p - tree.origin();
  double out = 0;
  for (int k = 0; k < 3; ++k) {
    out = std::max({out, double(n.min[size_t(k)]) - q[k], q[k] - double(n.max[size_t(k)])});
  }
  return out;
}

double outside(const ObbTree& tree, const ObbTree::Node& n, const Vec3& p) {
  const Vec3 q = p - tree.origin();
  double out = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    double along = 0;
    for (size_t k = 0; k < 3; ++k) {
      along += double(n.axes[3 * k + axis]) * (q[int(k)] - double(n.centre[k]));
    }
    out = std::max(out, std::fabs(along) - double(n.half[axis]));
  }
  return out;
}

double outside(const SphereTree& tree, const SphereTree::Node& n, const Vec3& p) {
  return (p - tree.origin() - SphereKind::centre(n)).norm() - double(n.radius);
}

double outside(const HullTree& tree, const HullTree::Node& n, const Vec3& p) {
  const auto hull = tree.kind().points(tree.mesh(), n, {});
  CHECK(hull.size() <= HullKind::max_points);
  const double box = std::max({double(n.min[0]) - (p - tree.origin()).x(), 0.0});
  return std::max(box, hull_distance({&p, 1}, hull).lower - double(n.radius));
}

template <class Tree>
void check_containment(const MeshPtr& mesh, double tolerance, TreeBuilder builder) {
  const Tree tree(mesh, {builder});
  const std::string kind_name(tree.name());
  CAPTURE(kind_name);
  const auto& nodes = tree.nodes();
  const double slack = tolerance * tree.size() + tree.slack();
  std::vector<int> seen(mesh->triangles.size(), 0);
  double worst = 0;
  const std::function<void(uint32_t, std::vector<uint32_t>)> walk =
      [&](uint32_t i, std::vector<uint32_t> above) {
        above.push_back(i);
        if (!nodes[i].is_leaf()) {
          walk(i + 1, above);
          walk(nodes[i].start, above);
          return;
        }
        CHECK(nodes[i].count <= Tree::max_leaf_triangles);
        for (uint32_t k = nodes[i].start; k < nodes[i].start + nodes[i].count; ++k) {
          const uint32_t t = tree.triangle_order()[k];
          ++seen[t];
          for (uint32_t n : above) {
            for (size_t c = 0; c < 3; ++c) {
              worst = std::max(worst, outside(tree, nodes[n], mesh->corner(t, c)));
            }
          }
        }
      };
  walk(0, {});
  CAPTURE(worst / tree.size());
  CHECK(worst <= slack);
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  CHECK(tree.depth() < Tree::max_depth);
  CHECK(tree.node_count() == nodes.size());
}

std::vector<Float4> as_float(const std::vector<Vec3>& points) {
  std::vector<Float4> out;
  for (const Vec3& p : points) out.push_back(to_float4(p));
  return out;
}

double area(const Vec3& e) {
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

/// Half the area of the box along random axes that is smallest.
double best_random_area(Random& r, const std::vector<Vec3>& points) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3000; ++i) {
    const Quat q = draws::rotation(r);
    Aabb box;
    for (const Vec3& p : points) box.include(q * p);
    best = std::min(best, area(box.extent()));
  }
  return best;
}

}  // namespace

TEST_CASE("every triangle lies in the volumes of all nodes above it, exactly one leaf holds it") {
  for (const auto& [family, mesh] : families()) {
    const std::string name = family;
    CAPTURE(name);
    for (const TreeBuilder builder : {TreeBuilder::surface_area, TreeBuilder::longest_axis}) {
      check_containment<AabbTree>(mesh, 0, builder);
      check_containment<ObbTree>(mesh, 1e-7, builder);
      check_containment<SphereTree>(mesh, 0, builder);
      check_containment<HullTree>(mesh, 0, builder);
    }
  }
}

TEST_CASE("axes of boxes are at right angles, however narrow the triangles") {
  for (const auto& [family, mesh] : families()) {
    const std::string name = family;
    CAPTURE(name);
    const ObbTree tree(mesh);
    double worst = 0;
    for (const ObbTree::Node& n : tree.nodes()) {
      const float* const a = n.axes.data();
      const Mat3 axes = Mat3f(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]).cast<double>();
      worst = std::max(worst, (axes.transpose() * axes - Mat3::Identity()).norm());
    }
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("the wide tree of rays follows a refit") {
  const MeshPtr torus = share(make_mesh::torus(1, 0.3, 20, 10));
  AabbTree tree(torus);
  const Ray down{Vec3(1, 0, 9), -Vec3::UnitZ()};
  REQUIRE(tree.ray(down, 99));
  REQUIRE(tree.refit(share(transformed(*torus, {Vec3(5, 0, 0), Quat::Identity()}))).ok());
  CHECK_FALSE(tree.ray(down, 99));
  CHECK(tree.ray({Vec3(6, 0, 9), -Vec3::UnitZ()}, 99));
}

TEST_CASE("bytes per triangle stay within 60 for boxes and 120 for the others") {
  const MeshPtr torus = share(make_mesh::torus(1, 0.3, 200, 100));
  for (const HierarchyKind& kind : all_hierarchies()) {
    CAPTURE(kind.name);
    const auto tree = kind.build(torus);
    // With what the first ray adds.
    CHECK(tree->ray({Vec3(1, 0, 9), -Vec3::UnitZ()}, 99));
    CHECK(tree->state_bytes() <= (kind.name == "aabb" ? 60 : 120) * torus->triangles.size());
    CHECK(tree->depth() < 40);
  }
}

TEST_CASE("the same mesh gives the same tree, node by node") {
  Random r(60);
  const MeshPtr mesh = share(soup(r, 500, 0.2));
  const ObbTree a(mesh), b(share(*mesh));
  REQUIRE(a.nodes().size() == b.nodes().size());
  CHECK(std::ranges::equal(a.triangle_order(), b.triangle_order()));
  for (size_t i = 0; i < a.nodes().size(); ++i) {
    CHECK(a.nodes()[i].axes == b.nodes()[i].axes);
    CHECK(a.nodes()[i].centre == b.nodes()[i].centre);
    CHECK(a.nodes()[i].half == b.nodes()[i].half);
  }
}

TEST_CASE("minimal spheres: no smaller one exists") {
  Random r(61);
  for (int i = 0; i < draws::count(2000); ++i) {
    std::vector<Vec3> points = draws::points(r, 1 + r.below(30));
    const int family = i % 6;
    if (family == 1)
      for (Vec3& p : points) p.normalize();
    if (family == 2)
      for (Vec3& p : points) p.z() = 0;
    if (family == 3)
      for (Vec3& p : points) p = Vec3(p.x(), 2 * p.x(), -p.x());
    if (family == 4)
      for (Vec3& p : points) p = p.array().round();
    if (family == 5)
      for (Vec3& p : points) p = p * 1e-3 + Vec3(100, 0, 0);
    const Sphere s = minimal_sphere(points);
    double furthest = 0;
    for (const Vec3& p : points) furthest = std::max(furthest, (p - s.centre).norm());
    CHECK(furthest <= s.radius * (1 + 1e-15));
    // Badoiu & Clarkson 2003: stepping towards the furthest point by 1/(k+1) converges to the
    // centre; its radius is an upper bound within 1/k of the least.
    Vec3 centre = points[0];
    double least = std::numeric_limits<double>::infinity();
    for (int k = 1; k < 1000; ++k) {
      const Vec3* far = &points[0];
      for (const Vec3& p : points) {
        if ((p - centre).squaredNorm() > (*far - centre).squaredNorm()) far = &p;
      }
      least = std::min(least, (*far - centre).norm());
      centre += (*far - centre) / (k + 1);
    }
    CHECK(s.radius <= least * (1 + 1e-9) + 1e-13);
    CHECK(s.radius >= 0.9 * least - 1e-13);
  }
}

TEST_CASE("boxes are tight: exact for turned boxes, near the best of 3000 rotations otherwise") {
  Random r(62);
  double ratio_sum = 0, worst = 0;
  int n = 0;
  for (int i = 0; i < draws::count(60); ++i) {
    const Quat turn = draws::rotation(r);
    const bool brick = i % 3 == 0;
    const Vec3 half(1, 0.5, 0.1);
    std::vector<Vec3> points;
    if (brick) {
      for (int c = 0; c < 8; ++c) {
        points.push_back(turn *
                         half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
      }
    } else {
      for (const Vec3& p : draws::points(r, 60)) points.push_back(turn * half.cwiseProduct(p));
    }
    const auto floats = as_float(points);
    ExtremePoints extreme(floats[0]);
    for (const Float4& p : floats) extreme.include(p);
    const auto e = fit_box(floats, tight_axes(extreme)).half.array();
    const double found = 4 * area(Vec3(double(e[0]), double(e[1]), double(e[2])));
    const double best = brick ? 4 * area(half) : best_random_area(r, points);
    worst = std::max(worst, found / best);
    ratio_sum += found / best;
    ++n;
    if (brick) CHECK(found == doctest::Approx(best).epsilon(1e-5));
  }
  CHECK(worst < 1.35);
  CHECK(ratio_sum / n < 1.1);
}
