// Two hierarchies at once, and one with itself. Reference: brute force over all pairs of triangles,
// whose answers every kind must equal bit for bit; brute force's decisions against
// triangles_intersect (exact) and against closest_triangle_triangle (rounding 1e-12 of the size).
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using namespace tumble::hard_meshes;
constexpr double no_limit = std::numeric_limits<double>::infinity();

bool equal(const std::optional<MeshDistance>& a, const std::optional<MeshDistance>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->triangles == b->triangles && a->on_a == b->on_a && a->on_b == b->on_b &&
         a->squared_distance == b->squared_distance;
}

struct Built {
  const HierarchyKind* kind;
  std::unique_ptr<Hierarchy> tree;
};

std::vector<Built> build_all(const MeshPtr& mesh) {
  std::vector<Built> out;
  for (const HierarchyKind& kind : all_hierarchies()) {
    if (kind.name == "brute_force") continue;
    out.push_back({&kind, kind.build(mesh)});
    out.push_back({&kind, kind.build(mesh, {TreeBuilder::longest_axis})});
  }
  return out;
}

/// B's mesh turned, its centre within `apart` of A's.
Pose random_pose(Random& r, const Hierarchy& a, const Hierarchy& b, double apart) {
  Pose pose{Vec3::Zero(), draws::rotation(r)};
  pose.x = a.bounds().centre() - pose.direction(b.bounds().centre()) + draws::in_box(r, apart);
  return pose;
}

}  // namespace

TEST_CASE("pairs, first hit and distance of two meshes equal brute force for every kind") {
  const auto meshes = families();
  int queries = 0, met = 0, apart = 0;
  for (const auto& [first_name, mesh_a] : meshes) {
    const auto& name_a = first_name;
    const BruteForceHierarchy ref_a(mesh_a);
    const auto trees_a = build_all(mesh_a);
    for (const auto& [second_name, mesh_b] : meshes) {
      const auto& name_b = second_name;
      if (&mesh_b < &mesh_a && !test::all_counts()) continue;  // the gate has one of (a, b), (b, a)
      if (&mesh_b != &mesh_a && test::only_to_run()) continue;
      INFO(name_a, " with ", name_b);
      const BruteForceHierarchy ref_b(mesh_b);
      const auto trees_b = build_all(mesh_b);
      Random r(72 + uint64_t(queries));
      for (int k = 0; k < draws::count(4); ++k) {
        Pose pose = random_pose(r, ref_a, ref_b, k == 3 ? 4 : 1);
        if (k == 0) pose = {ref_a.bounds().centre() - ref_b.bounds().centre(), Quat::Identity()};
        const double margin = k == 1 ? 0.05 : 0;
        std::vector<TriangleIds> expected;
        ref_a.pairs(ref_b, pose, margin, expected);
        const bool hit = ref_a.intersects(ref_b, pose);
        const double reach = k == 2 ? 0.5 : no_limit;
        const auto near = ref_a.distance(ref_b, pose, reach);
        ++queries;
        met += hit;
        apart += !hit && near;
        if (margin == 0) CHECK(hit == !expected.empty());
        for (size_t i = 0; i < trees_a.size(); ++i) {
          CAPTURE(trees_a[i].kind->name);
          const Hierarchy &a = *trees_a[i].tree, &b = *trees_b[i].tree;
          std::vector<TriangleIds> found;
          a.pairs(b, pose, margin, found);
          CHECK(found == expected);
          CHECK(a.intersects(b, pose) == hit);
          CHECK(equal(a.distance(b, pose, reach), near));
        }
        // A partner of another kind.
        const size_t other = size_t(k) % trees_b.size();
        std::vector<TriangleIds> found;
        trees_a[(other + 2) % trees_a.size()].tree->pairs(*trees_b[other].tree, pose, margin,
                                                          found);
        CHECK(found == expected);
        found.clear();
        trees_a[other].tree->pairs(ref_b, pose, margin, found);
        CHECK(found == expected);
      }
    }
  }
  if (test::only_to_run()) return;  // too few pairs of meshes for shares of them
  CHECK(met > queries / 4);
  CHECK(apart > queries / 20);
}

TEST_CASE(
    "what is reported as meeting is exactly what the primitive test says, the rest is apart") {
  Random r(81);
  int meeting = 0;
  const int n = draws::count(200000);
  for (int i = 0; i < n; ++i) {
    TriangleCorners a = draws::triangle(r), b = draws::triangle(r);
    const int family = i % 8;
    if (family == 1) b[0] = a[r.below(3)];
    if (family == 2) b[1] = 0.5 * (a[0] + a[1]);
    if (family == 3)
      for (Vec3& p : b) p.z() = a[0].z();
    if (family == 3)
      for (Vec3& p : a) p.z() = a[0].z();
    if (family == 4) a[2] = a[1];
    if (family == 5)
      for (Vec3& p : b) p = (8 * p).array().round() / 8;
    if (family == 5)
      for (Vec3& p : a) p = (8 * p).array().round() / 8;
    if (family == 6) b[2] = b[1] + 1e-15 * draws::direction(r);
    if (family == 7)
      for (TriangleCorners* t : {&a, &b})
        for (Vec3& p : *t) p = p * 1e-60 + Vec3(1e-60, 0, 0);
    const bool expected = triangles_intersect(a, b);
    CHECK(triangles_meet(a, b) == expected);
    CHECK(triangles_meet(b, a) == expected);
    meeting += expected;
    const double d = std::sqrt(closest_triangle_triangle(a, b).squared_distance);
    if (family == 0) CHECK((d < 1e-12) == expected);
    if (family < 7) {
      CHECK(triangles_near(a, b, d + 1e-9));
      if (d > 1e-6) CHECK_FALSE(triangles_near(a, b, d - 1e-9));
    }
  }
  if (n > 1000) {
    CHECK(meeting > n / 10);
    CHECK(meeting < n / 2);
  }
}

TEST_CASE("a mesh with itself: pairs equal brute force, neighbours are not reported") {
  auto meshes = families();
  // A closed mesh folded through itself, and one that is not.
  TriangleMesh folded = make_mesh::torus(1, 0.4, 24, 12);
  for (Vec3& v : folded.vertices) v.x() = std::fabs(v.x() - 0.3);
  meshes.push_back({"folded", share(std::move(folded))});
  int with_pairs = 0;
  for (const auto& [name, mesh] : meshes) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    for (const double margin : {0.0, 0.05}) {
      std::vector<TriangleIds> expected;
      BruteForceHierarchy(mesh).self_pairs(margin, expected);
      with_pairs += !expected.empty();
      for (const Built& built : build_all(mesh)) {
        CAPTURE(built.kind->name);
        std::vector<TriangleIds> found;
        built.tree->self_pairs(margin, found);
        CHECK(found == expected);
      }
      for (const TriangleIds& ids : expected) {
        CHECK(ids.a < ids.b);
        CHECK_FALSE(neighbours(*mesh, ids.a, ids.b));
      }
    }
  }
  CHECK(with_pairs > 6);
  std::vector<TriangleIds> none;
  all_hierarchies()[0].build(share(make_mesh::torus(1, 0.4, 48, 24)))->self_pairs(0, none);
  CHECK(none.empty());
}

TEST_CASE("soups as small and as large as a mesh may be: pairs equal brute force") {
  Random random(83);
  for (const double scale : {1e-150, 1e-100, 1e-30, 5e8}) {
    CAPTURE(scale);
    for (int i = 0; i < draws::count(6); ++i) {
      auto mesh = std::make_shared<TriangleMesh>();
      for (int k = 0; k < 60; ++k) mesh->vertices.push_back(scale * draws::in_box(random, 1));
      for (int k = 0; k < 80; ++k) {
        mesh->triangles.push_back(
            {uint32_t(random.below(60)), uint32_t(random.below(60)), uint32_t(random.below(60))});
      }
      const Pose pose{scale * draws::in_box(random, 1), draws::rotation(random)};
      std::vector<TriangleIds> own, both;
      for (const HierarchyKind& kind : all_hierarchies()) {
        if (kind.name != "brute_force") continue;
        const auto tree = kind.build(mesh);
        tree->self_pairs(0, own);
        tree->pairs(*tree, pose, 0, both);
      }
      for (const HierarchyKind& kind : all_hierarchies()) {
        CAPTURE(kind.name);
        const auto tree = kind.build(mesh);
        std::vector<TriangleIds> own_found, both_found;
        tree->self_pairs(0, own_found);
        tree->pairs(*tree, pose, 0, both_found);
        CHECK(own_found == own);
        CHECK(both_found == both);
      }
    }
  }
}

TEST_CASE("an empty mesh answers nothing, for every kind, also as a partner") {
  const MeshPtr empty = share({}), torus = share(make_mesh::torus(1, 0.4, 8, 6));
  for (const HierarchyKind& kind : all_hierarchies()) {
    CAPTURE(kind.name);
    const auto a = kind.build(empty), b = kind.build(torus);
    std::vector<TriangleIds> pairs;
    std::vector<uint32_t> triangles;
    a->pairs(*b, {}, 1, pairs);
    b->pairs(*a, {}, 1, pairs);
    a->self_pairs(1, pairs);
    a->swept_pairs(*b, {}, pairs);
    CHECK(pairs.empty());
    CHECK_FALSE(a->intersects(*b, {}));
    CHECK_FALSE(b->distance(*a, {}, no_limit));
    CHECK_FALSE(a->ray({}, no_limit));
    CHECK_FALSE(a->closest(Vec3::Zero(), no_limit));
    a->overlap({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, triangles);
    CHECK(triangles.empty());
    CHECK(a->refit(empty));
    CHECK_FALSE(a->refit(torus));
  }
}
