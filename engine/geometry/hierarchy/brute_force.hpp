#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// No structure: tests every triangle. The reference for the other kinds.
class BruteForceHierarchy final : public Hierarchy {
 public:
  explicit BruteForceHierarchy(std::shared_ptr<const TriangleMesh> mesh, const TreeOptions& = {})
      : Hierarchy(std::move(mesh)) {}

  std::string_view name() const override { return "brute_force"; }
  size_t state_bytes() const override { return 0; }
  void visit_nodes(const std::function<bool(const NodeBound&)>&) const override {}
  void overlap(const Aabb& box, std::vector<uint32_t>& out) const override;
  std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const override;
  std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const override;
  void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
             std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const override;
  bool intersects(const Hierarchy& other, const Pose& other_pose,
                  HierarchyStatistics* cost = nullptr) const override;
  void self_pairs(double margin, std::vector<TriangleIds>& out,
                  HierarchyStatistics* cost = nullptr) const override;
  std::optional<MeshDistance> distance(const Hierarchy& other, const Pose& other_pose,
                                       double max_distance,
                                       HierarchyStatistics* cost = nullptr) const override;
  void swept_pairs(const Hierarchy& other, const SweptQuery& query, std::vector<TriangleIds>& out,
                   HierarchyStatistics* cost = nullptr) const override;

 private:
  void refit_nodes() override {}
};

}  // namespace tumble
