// Hierarchies. Reference: brute force over all triangles, whose answers every kind must equal bit
// for bit; brute force itself against distances and intersections of single triangles.
#include "engine/core/registry.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using MeshPtr = std::shared_ptr<const TriangleMesh>;
constexpr double infinity = std::numeric_limits<double>::infinity();

MeshPtr share(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

TriangleMesh soup(Random& r, int n, double size) {
  TriangleMesh m;
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = draws::in_box(r, 1);
    for (const Vec3& c : draws::triangle(r, size)) m.vertices.push_back(centre + c);
    const auto k = uint32_t(3 * i);
    m.triangles.push_back({k, k + 1, k + 2});
  }
  return m;
}

/// Meshes that hierarchies find hard, by name.
std::vector<std::pair<const char*, MeshPtr>> families() {
  Random r(70);
  std::vector<std::pair<const char*, MeshPtr>> out;
  out.emplace_back("torus", share(make_mesh::torus(1, 0.4, 16, 8)));
  out.emplace_back("one triangle", share(soup(r, 1, 1)));
  out.emplace_back("soup of small", share(soup(r, 200, 0.1)));
  out.emplace_back("soup of large", share(soup(r, 100, 2)));
  TriangleMesh same;
  for (int i = 0; i < 60; ++i) append(same, make_mesh::tetrahedron(1));
  out.emplace_back("coincident", share(std::move(same)));
  TriangleMesh flat = make_mesh::terrain(2, 12, [](double, double) { return 0.25; });
  out.emplace_back("flat grid", share(std::move(flat)));
  TriangleMesh points = soup(r, 50, 0);
  out.emplace_back("triangles that are points", share(std::move(points)));
  TriangleMesh scales;  // sizes and places over thirty powers of two
  for (int i = 0; i < 60; ++i) {
    const double s = std::ldexp(1.0, -i / 2);
    append(scales, transformed(scaled(make_mesh::tetrahedron(1), Vec3::Constant(0.3 * s)),
                               {Vec3(s, 0, 0), Quat::Identity()}));
  }
  out.emplace_back("geometric series", share(std::move(scales)));
  out.emplace_back("far away", share(transformed(make_mesh::icosphere(1, 2),
                                                 {Vec3(1e5, 2e5, -3e5), Quat::Identity()})));
  return out;
}

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
  for (const auto& family : families()) {
    const char* name = family.first;
    const MeshPtr& mesh = family.second;
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

TEST_CASE("hierarchy against hierarchy: the same pairs in the same order for all kinds") {
  const auto meshes = families();
  int queries = 0, found_some = 0;
  for (size_t i = 0; i < meshes.size(); ++i) {
    for (size_t j = 0; j < meshes.size(); ++j) {
      const char *name_a = meshes[i].first, *name_b = meshes[j].first;
      const MeshPtr &mesh_a = meshes[i].second, &mesh_b = meshes[j].second;
      CAPTURE(name_a);
      CAPTURE(name_b);
      Random r(72 + 100 * i + j);
      for (int k = 0; k < draws::count(3); ++k) {
        const BruteForceHierarchy ref_a(mesh_a), ref_b(mesh_b);
        Pose pose{Vec3::Zero(), k == 0 ? Quat::Identity() : draws::rotation(r)};
        pose.x = ref_a.bounds().centre() - pose.direction(ref_b.bounds().centre()) +
                 (k == 0 ? 0 : 1) * draws::in_box(r, 1);
        const double margin = k % 3 == 0 ? 0 : 0.05;
        std::vector<TriangleIds> expected;
        ref_a.pairs(ref_b, pose, margin, expected);
        ++queries;
        found_some += !expected.empty();
        for (const HierarchyKind& kind_a : all_hierarchies()) {
          for (const HierarchyKind& kind_b : all_hierarchies()) {
            std::vector<TriangleIds> found;
            kind_a.build(mesh_a)->pairs(*kind_b.build(mesh_b), pose, margin, found);
            CHECK(found == expected);
          }
        }
        if (k != 1) continue;
        // Nothing nearer than the margin is missing.
        for (uint32_t a = 0; a < mesh_a->triangles.size(); a += 7) {
          for (uint32_t b = 0; b < mesh_b->triangles.size(); b += 7) {
            std::array<Vec3, 3> ta, tb;
            for (size_t c = 0; c < 3; ++c) {
              ta[c] = mesh_a->corner(a, c);
              tb[c] = pose.point(mesh_b->corner(b, c));
            }
            if (closest_triangle_triangle(ta, tb).squared_distance > margin * margin) continue;
            CHECK(std::binary_search(expected.begin(), expected.end(), TriangleIds{a, b}));
          }
        }
      }
    }
  }
  CHECK(found_some > queries / 3);
}

TEST_CASE("an AABB tree contains its triangles, is flat and small, and of bounded depth") {
  for (const auto& family : families()) {
    const char* name = family.first;
    const MeshPtr& mesh = family.second;
    CAPTURE(name);
    const AabbTree tree(mesh);
    std::vector<int> seen(mesh->triangles.size(), 0);
    const auto& nodes = tree.nodes();
    // Parents contain their children: checked by walking down with the boxes of all ancestors.
    const std::function<void(uint32_t, std::vector<Aabb>)> walk = [&](uint32_t i,
                                                                      std::vector<Aabb> above) {
      above.push_back(tree.node_box(i).inflated(1e-14 * (1 + tree.origin().norm())));
      if (!nodes[i].is_leaf()) {
        walk(i + 1, above);
        walk(nodes[i].start, above);
        return;
      }
      for (uint32_t k = nodes[i].start; k < nodes[i].start + nodes[i].count; ++k) {
        const uint32_t t = tree.triangle_order()[k];
        ++seen[t];
        for (const Aabb& box : above) {
          for (size_t c = 0; c < 3; ++c) CHECK(box.contains(mesh->corner(t, c)));
        }
      }
    };
    walk(0, {});
    CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
    CHECK(tree.depth() < AabbTree::max_depth);
  }
  const MeshPtr torus = share(make_mesh::torus(1, 0.3, 200, 100));
  const AabbTree tree(torus);
  CHECK(tree.state_bytes() <= 60 * torus->triangles.size());
  CHECK(tree.depth() < 40);
}

TEST_CASE("1e5 identical triangles, and sizes that halve a thousand times, do not break the tree") {
  TriangleMesh repeated;
  repeated.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  repeated.triangles.assign(100000, {0, 1, 2});
  const AabbTree tree(share(std::move(repeated)));
  CHECK(tree.depth() < AabbTree::max_depth);
  CHECK(tree.closest(Vec3(0.2, 0.2, 1), infinity)->triangle == 0);
  CHECK(tree.ray({Vec3(0.2, 0.2, 1), -Vec3::UnitZ()}, infinity)->triangle == 0);

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
  const AabbTree deep(mesh);
  const BruteForceHierarchy reference(mesh);
  CHECK(deep.depth() < AabbTree::max_depth);
  Random r(73);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = std::ldexp(1.0, -int(r.below(60))) * draws::in_box(r, 1);
    CHECK(same(deep.closest(p, infinity), reference.closest(p, infinity)));
  }
}

TEST_CASE("kinds are found by name, and a wrong name gets a suggestion") {
  CHECK(find_named(all_hierarchies(), "aabb", "hierarchy").ok());
  CHECK(find_named(all_hierarchies(), "brute_force", "hierarchy").ok());
  const auto wrong = find_named(all_hierarchies(), "abb", "hierarchy");
  REQUIRE_FALSE(wrong.ok());
  CHECK(wrong.error().message.find("did you mean 'aabb'") != std::string::npos);
}
