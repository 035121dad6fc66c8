#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// No structure at all: looks at every triangle. The reference for the other kinds.
class BruteForceHierarchy final : public Hierarchy {
 public:
  explicit BruteForceHierarchy(std::shared_ptr<const TriangleMesh> mesh)
      : Hierarchy(std::move(mesh)) {}

  std::string_view name() const override { return "brute_force"; }
  size_t state_bytes() const override { return 0; }
  void overlap(const Aabb& box, std::vector<uint32_t>& out) const override;
  std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const override;
  std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const override;
  void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
             std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const override;
};

}  // namespace tumble
