// Contacts of two meshes do not depend on the kind of hierarchy that finds their near triangles.
// Reference: all pairs of triangles ("brute_force").
#include "engine/collision/narrow_phase.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <cstring>

using namespace tumble;
using namespace tumble::test;

namespace {

bool same_point(const ManifoldPoint& a, const ManifoldPoint& b) {
  return a.x_world == b.x_world && a.gap == b.gap && a.feature == b.feature;
}

bool same_manifolds(const std::vector<Manifold>& a, const std::vector<Manifold>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].normal != b[i].normal || a[i].part != b[i].part || a[i].count != b[i].count)
      return false;
    for (size_t k = 0; k < size_t(a[i].count); ++k)
      if (!same_point(a[i].points[k], b[i].points[k])) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("contacts of meshes are the same whatever hierarchy finds the near triangles") {
  Random r(53);
  const std::vector<std::shared_ptr<const Shape>> meshes{
      mesh(make_mesh::torus(0.5, 0.2, 24, 12)), mesh(make_mesh::torus(0.5, 0.05, 32, 8)),
      mesh(make_mesh::box({0.4, 0.05, 0.3})),
      mesh(make_mesh::terrain(2, 12, [](double x, double z) { return 0.1 * x * z; }))};
  const std::vector<HierarchyKind>& kinds = all_hierarchies();
  const HierarchyKind* brute = nullptr;
  for (const HierarchyKind& kind : kinds)
    if (kind.name == "brute_force") brute = &kind;
  REQUIRE(brute);
  int touching = 0;
  const int n = std::max(40, cases(400));
  for (int i = 0; i < n; ++i) {
    const Shape& a = *meshes[size_t(r.uniform(0, 3))];
    const Shape& b = *meshes[size_t(r.uniform(0, 4))];
    const Pose pa{random_vec(r, -5, 5), random_rotation(r)};
    const Pose pb{pa.x + random_vec(r, -0.8, 0.8), random_rotation(r)};
    const double margin = i % 3 ? 0.02 : 0.0;
    std::vector<Manifold> reference;
    collide(a, pa, b, pb, {margin, brute}, reference);
    touching += !reference.empty();
    for (const HierarchyKind& kind : kinds) {
      std::vector<Manifold> found;
      collide(a, pa, b, pb, {margin, &kind}, found);
      INFO(i, " ", kind.name);
      CHECK(same_manifolds(found, reference));
    }
    std::vector<Manifold> found;
    collide(a, pa, b, pb, margin, found);
    INFO(i);
    CHECK(same_manifolds(found, reference));
  }
  CHECK(touching > n / 5);
}
