// Hierarchies. Reference: brute force over all triangles, whose answers every kind must equal bit
// for bit; brute force itself against distances and intersections of single triangles.
#include "engine/core/registry.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using namespace tumble::hard_meshes;
constexpr double infinity = std::numeric_limits<double>::infinity();

bool same(const std::optional<MeshRayHit>& a, const std::optional<MeshRayHit>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->t == b->t && a->triangle == b->triangle && a->barycentric == b->barycentric &&
         a->front == b->front;
}

bool same(const std::optional<MeshPoint>& a, const std::optional<MeshPoint>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->triangle == b->triangle && a->point == b->point && a->feature == b->feature &&
         a->squared_distance == b->squared_distance;
}

}  // namespace

TEST_CASE("every hierarchy answers overlap, ray and closest-point queries as brute force does") {
  for (const auto& [family, mesh] : families()) {
    const std::string name = family;
    CAPTURE(name);
    const BruteForceHierarchy reference(mesh);
    const Vec3 centre = reference.bounds().centre();
    const double size = reference.bounds().extent().norm() + 0.1;
    for (const HierarchyKind& kind : all_hierarchies()) {
      CAPTURE(kind.name);
      const auto tree = kind.build(mesh);
      CHECK(tree->name() == kind.name);
      Random r(71);
      int rays = 0, boxes = 0, near = 0;
      const int n = draws::count(400);
      for (int i = 0; i < n; ++i) {
        Vec3 p = centre + draws::in_box(r, size);
        if (i % 4 == 1) p = mesh->corner(r.below(uint32_t(mesh->triangles.size())), size_t(i % 3));
        Aabb box;
        box.include(p);
        box.include(p + (i % 3) * 0.3 * draws::in_box(r, size));
        std::vector<uint32_t> found{12345}, expected{12345};
        tree->overlap(box, found);
        reference.overlap(box, expected);
        CHECK(found == expected);
        boxes += expected.size() > 1;

        Ray ray{p, draws::direction(r) * 3};
        if (i % 2) ray.direction = centre + draws::in_box(r, 0.2 * size) - p;
        if (i % 8 == 3) ray.direction = Vec3::Unit(i % 3);
        const double t_max = i % 5 ? infinity : 0.4;
        const auto hit = reference.ray(ray, t_max);
        CHECK(same(tree->ray(ray, t_max), hit));
        rays += hit.has_value();

        const double reach = i % 3 ? infinity : 0.2 * size;
        const auto point = reference.closest(p, reach);
        CHECK(same(tree->closest(p, reach), point));
        near += point.has_value();
      }
      if (n > 100) {
        CHECK(boxes > n / 10);
        CHECK(near > n / 2);
        CHECK(near <= n);
        if (mesh->triangles.size() > 100) CHECK(rays > n / 10);
      }
    }
  }
}

TEST_CASE("1e5 identical triangles, and sizes that halve a thousand times, do not break the tree" *
          doctest::test_suite("long")) {
  TriangleMesh repeated;
  repeated.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  repeated.triangles.assign(100000, {0, 1, 2});
  const MeshPtr many = share(std::move(repeated));
  for (const HierarchyKind& kind : all_hierarchies()) {
    for (const TreeBuilder builder : {TreeBuilder::surface_area, TreeBuilder::longest_axis}) {
      const auto tree = kind.build(many, {builder});
      CHECK(tree->depth() < AabbTree::max_depth);
      CHECK(tree->closest(Vec3(0.2, 0.2, 1), infinity)->triangle == 0);
      CHECK(tree->ray({Vec3(0.2, 0.2, 1), -Vec3::UnitZ()}, infinity)->triangle == 0);
    }
  }

  TriangleMesh halving;
  for (int i = 0; i < 1000; ++i) {
    const double s = std::ldexp(1.0, -i);
    for (const Vec3& v : {Vec3(s, 0, 0), Vec3(s, s / 8, 0), Vec3(s, 0, s / 8)}) {
      halving.vertices.push_back(v);
    }
    const auto k = uint32_t(3 * i);
    halving.triangles.push_back({k, k + 1, k + 2});
  }
  const MeshPtr mesh = share(std::move(halving));
  const BruteForceHierarchy reference(mesh);
  for (const HierarchyKind& kind : all_hierarchies()) {
    CAPTURE(kind.name);
    const auto deep = kind.build(mesh);
    CHECK(deep->depth() < AabbTree::max_depth);
    Random r(73);
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = std::ldexp(1.0, -int(r.below(60))) * draws::in_box(r, 1);
      CHECK(same(deep->closest(p, infinity), reference.closest(p, infinity)));
    }
  }
}

TEST_CASE("kinds are found by name, and a wrong name gets a suggestion") {
  CHECK(find_named(all_hierarchies(), "aabb", "hierarchy").ok());
  CHECK(find_named(all_hierarchies(), "brute_force", "hierarchy").ok());
  const auto wrong = find_named(all_hierarchies(), "abb", "hierarchy");
  REQUIRE_FALSE(wrong.ok());
  CHECK(wrong.error().message.find("did you mean 'aabb'") != std::string::npos);
}
