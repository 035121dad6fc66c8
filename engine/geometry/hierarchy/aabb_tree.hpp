#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// Binary tree of axis-aligned boxes over the triangles of a mesh, stored flat in depth-first
/// order with single-precision boxes rounded outwards. Built top-down by the binned surface-area
/// heuristic (Wald 2007); where that cannot separate (equal centres) or grows too deep, by the
/// median, so that the depth is bounded for any input.
class AabbTree final : public Hierarchy {
 public:
  static constexpr uint32_t max_leaf_triangles = 4;
  static constexpr int max_depth = 96;

  explicit AabbTree(std::shared_ptr<const TriangleMesh> mesh);

  std::string_view name() const override { return "aabb"; }
  size_t state_bytes() const override;
  void overlap(const Aabb& box, std::vector<uint32_t>& out) const override;
  std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const override;
  std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const override;
  void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
             std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const override;

  /// Box relative to origin(), with a leaf's triangles or an inner node's second child. The first
  /// child of node i is node i + 1.
  struct Node {
    std::array<float, 3> min, max;
    uint32_t start;  ///< leaf: first place in triangle_order(); inner: number of the second child
    uint32_t count;  ///< triangles of a leaf; 0 for an inner node

    bool is_leaf() const { return count > 0; }
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<uint32_t>& triangle_order() const { return order_; }
  const Vec3& origin() const { return origin_; }
  /// Box of a node in the mesh's frame [m].
  Aabb node_box(uint32_t node) const;
  int depth() const { return depth_; }

 private:
  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;  ///< triangles by leaf
  Vec3 origin_ = Vec3::Zero();   ///< centre of the mesh's box
  double slack_ = 0;             ///< rounding allowance of node tests [m]
  int depth_ = 0;
};

}  // namespace tumble
