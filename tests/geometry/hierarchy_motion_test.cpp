// Hierarchies over meshes that move or deform. Reference for swept queries: the motion sampled at
// forty times, brute force at each; what any sample finds must be among the answers. Reference for
// refitting: a hierarchy built anew over the deformed mesh.
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

using namespace tumble::hard_meshes;
constexpr double without_limit = std::numeric_limits<double>::infinity();

/// A motion of the bounded kind: straight, turning by `angle` about a fixed axis.
struct Moving {
  MotionBound bound;
  Vec3 axis = Vec3::UnitX();

  Pose at(double s) const {
    const Quat q(axis_angle(axis, s * bound.angle));
    return {bound.centre + s * bound.translation - q * bound.centre, q};
  }
};

Moving random_motion(Random& r, const Vec3& centre, double size) {
  Moving m;
  m.bound.translation = r.uniform(0, size) * draws::direction(r);
  m.bound.centre = centre + draws::in_box(r, 0.2 * size);
  m.bound.angle = r.below(4) == 0 ? 0 : r.uniform(0, 2);
  m.axis = draws::direction(r);
  return m;
}

}  // namespace

TEST_CASE(
    "swept pairs hold every pair that sampled motions bring together, and equal brute force") {
  std::vector<Family> meshes;
  for (const Family& f : families()) {
    if (f.mesh->triangles.size() <= 260) meshes.push_back(f);
  }
  size_t sampled_pairs = 0, reported = 0, all = 0;
  for (size_t i = 0; i < meshes.size(); ++i) {
    const MeshPtr &mesh_a = meshes[i].mesh, &mesh_b = meshes[(i * 3 + 1) % meshes.size()].mesh;
    INFO(meshes[i].name, " with ", meshes[(i * 3 + 1) % meshes.size()].name);
    const BruteForceHierarchy ref_a(mesh_a), ref_b(mesh_b);
    Random r(90 + i);
    for (int k = 0; k < draws::count(3); ++k) {
      SweptQuery query;
      query.other_pose.q = draws::rotation(r);
      query.other_pose.x = ref_a.bounds().centre() + 1.5 * draws::direction(r) -
                           query.other_pose.direction(ref_b.bounds().centre());
      const Vec3 centre_b = query.other_pose.point(ref_b.bounds().centre());
      const Moving a = random_motion(r, ref_a.bounds().centre(), 0.5);
      const Moving b = random_motion(r, centre_b, 2);
      query.own = a.bound;
      query.other_motion = b.bound;
      query.margin = k == 1 ? 0.02 : 0;
      std::vector<TriangleIds> expected;
      ref_a.swept_pairs(ref_b, query, expected);
      reported += expected.size();
      all += mesh_a->triangles.size() * mesh_b->triangles.size();
      for (const HierarchyKind& kind : all_hierarchies()) {
        CAPTURE(kind.name);
        std::vector<TriangleIds> found;
        kind.build(mesh_a)->swept_pairs(*kind.build(mesh_b), query, found);
        CHECK(found == expected);
      }
      for (int step = 0; step <= 40; ++step) {
        const double s = step / 40.0;
        std::vector<TriangleIds> now;
        const Pose b_in_a = a.at(s).inverse() * (b.at(s) * query.other_pose);
        ref_a.pairs(ref_b, b_in_a, query.margin, now);
        sampled_pairs += now.size();
        CHECK(std::includes(expected.begin(), expected.end(), now.begin(), now.end()));
      }
    }
  }
  CHECK(sampled_pairs > 1000);
  CHECK(reported < all);
}

TEST_CASE("after refitting to a deformed mesh every kind answers as brute force does") {
  Random r(95);
  const TriangleMesh base = make_mesh::torus(1, 0.4, 20, 12);
  for (const HierarchyKind& kind : all_hierarchies()) {
    CAPTURE(kind.name);
    const auto tree = kind.build(share(base));
    for (int round = 0; round < 3; ++round) {
      TriangleMesh bent = base;
      for (Vec3& v : bent.vertices) {
        v = Vec3(v.x() + 0.3 * round * v.y() * v.y(), v.y() * (1 + round), v.z()) +
            0.1 * round * draws::in_box(r, 1) + Vec3(5.0 * round, 0, 0);
      }
      const MeshPtr mesh = share(bent);
      REQUIRE(tree->refit(mesh));
      const BruteForceHierarchy reference(mesh);
      for (int i = 0; i < draws::count(50); ++i) {
        const Vec3 p = reference.bounds().centre() + draws::in_box(r, 2);
        const auto near = tree->closest(p, without_limit);
        CHECK(near->point == reference.closest(p, without_limit)->point);
        const Ray ray{p, draws::direction(r)};
        const auto hit = tree->ray(ray, without_limit),
                   expected = reference.ray(ray, without_limit);
        CHECK(hit.has_value() == expected.has_value());
        if (hit && expected) CHECK(hit->triangle == expected->triangle);
      }
      std::vector<TriangleIds> found, expected;
      const Pose pose{Vec3(0.4, 0.1, 0), draws::rotation(r)};
      tree->pairs(*tree, pose, 0, found);
      reference.pairs(reference, pose, 0, expected);
      CHECK(found == expected);
      const auto again = kind.build(mesh);
      found.clear();
      again->pairs(*tree, pose, 0, found);
      CHECK(found == expected);
    }
    TriangleMesh other = base;
    other.triangles.pop_back();
    const Status refused = tree->refit(share(other));
    REQUIRE_FALSE(refused);
    CHECK(refused.error().cure == "build a new hierarchy");
  }
}
