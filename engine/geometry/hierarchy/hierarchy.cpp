#include "engine/geometry/hierarchy/hierarchy.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"

namespace tumble {

Hierarchy::Hierarchy(std::shared_ptr<const TriangleMesh> mesh)
    : mesh_(std::move(mesh)), bounds_(tumble::bounds(*mesh_)) {}

bool triangle_boxes_near(const TriangleMesh& mesh_a, uint32_t a, const TriangleMesh& mesh_b,
                         uint32_t b, const Pose& pose, double margin) {
  Aabb b_in_a, a_in_b;
  for (size_t k = 0; k < 3; ++k) {
    b_in_a.include(pose.point(mesh_b.corner(b, k)));
    a_in_b.include(pose.inverse_point(mesh_a.corner(a, k)));
  }
  return triangle_bounds(mesh_a, a).inflated(margin).overlaps(b_in_a) &&
         triangle_bounds(mesh_b, b).inflated(margin).overlaps(a_in_b);
}

const std::vector<HierarchyKind>& all_hierarchies() {
  static const std::vector<HierarchyKind> kinds = {
      {"aabb", "binary tree of axis-aligned boxes, surface-area heuristic",
       [](std::shared_ptr<const TriangleMesh> m) -> std::unique_ptr<Hierarchy> {
         return std::make_unique<AabbTree>(std::move(m));
       }},
      {"brute_force", "every triangle every time, to compare with",
       [](std::shared_ptr<const TriangleMesh> m) -> std::unique_ptr<Hierarchy> {
         return std::make_unique<BruteForceHierarchy>(std::move(m));
       }},
  };
  return kinds;
}

}  // namespace tumble
