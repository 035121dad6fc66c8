#include "engine/geometry/hierarchy/brute_force.hpp"

namespace tumble {

void BruteForceHierarchy::overlap(const Aabb& box, std::vector<uint32_t>& out) const {
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    if (triangle_bounds(*mesh_, t).overlaps(box)) out.push_back(t);
  }
}

std::optional<MeshRayHit> BruteForceHierarchy::ray(const Ray& ray, double t_max) const {
  const RayShear shear(ray);
  std::optional<MeshRayHit> best;
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    const auto hit =
        shear.triangle(mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2), t_max);
    if (!hit || (best && hit->t >= best->t)) continue;
    best = MeshRayHit{hit->t, t, hit->barycentric, hit->front};
  }
  return best;
}

std::optional<MeshPoint> BruteForceHierarchy::closest(const Vec3& p, double max_distance) const {
  std::optional<MeshPoint> best;
  const double limit = max_distance * max_distance;
  for (uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
    const TrianglePoint near =
        closest_on_triangle(p, mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2));
    if (!(near.squared_distance <= limit)) continue;
    if (best && near.squared_distance >= best->squared_distance) continue;
    best = MeshPoint{near.point, t, near.barycentric, near.feature, near.squared_distance};
  }
  return best;
}

void BruteForceHierarchy::pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                                std::vector<TriangleIds>& out, HierarchyStatistics* cost) const {
  for (uint32_t a = 0; a < mesh_->triangles.size(); ++a) {
    for (uint32_t b = 0; b < other.mesh().triangles.size(); ++b) {
      if (triangle_boxes_near(*mesh_, a, other.mesh(), b, other_pose, margin))
        out.push_back({a, b});
    }
  }
  if (cost) cost->triangle_tests += mesh_->triangles.size() * other.mesh().triangles.size();
}

}  // namespace tumble
