#pragma once
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/hierarchy/node_bound.hpp"
#include "engine/geometry/hierarchy/tree_layout.hpp"
#include "engine/geometry/hierarchy/triangle_decisions.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace tumble {

/// First hit of a ray with a mesh.
struct MeshRayHit {
  double t = 0;  ///< in units of the length of the ray's direction
  uint32_t triangle = no_index;
  Vec3 barycentric = Vec3::Zero();
  bool front = true;  ///< the ray meets the triangle's outer side
};

/// Nearest point of a mesh.
struct MeshPoint {
  Vec3 point = Vec3::Zero();
  uint32_t triangle = no_index;
  Vec3 barycentric = Vec3::Zero();
  TriangleFeature feature = TriangleFeature::face;
  double squared_distance = 0;  ///< [m^2]
};

/// The nearest points of two meshes, in the first mesh's frame.
struct MeshDistance {
  TriangleIds triangles{no_index, no_index};
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
  double squared_distance = 0;  ///< [m^2]
};

/// Cost of a query.
struct HierarchyStatistics {
  size_t node_tests = 0;
  size_t triangle_tests = 0;
};

/// A query for the triangles of two moving meshes that may come near each other.
struct SweptQuery {
  Pose other_pose;                ///< of the other mesh at the start, in this mesh's frame
  MotionBound own, other_motion;  ///< both in this mesh's frame as it stands at the start
  double margin = 0;              ///< [m]
};

struct TreeOptions {
  TreeBuilder builder = TreeBuilder::surface_area;
};

/// Finds triangles of one mesh quickly. All kinds, brute force included, give exactly the same
/// results, because results are decided triangle by triangle by functions that all kinds share
/// (triangle_decisions.hpp); nodes only exclude triangles that those would reject.
///
/// Built over a mesh that passed validate(), or an empty one; it shares ownership of it. Queries
/// are const and may run in many threads at once. Poses map the other mesh's frame to this one's.
/// Margins and distances are not negative.
class Hierarchy {
 public:
  virtual ~Hierarchy() = default;

  virtual std::string_view name() const = 0;
  /// Memory of the structure, without the mesh [bytes].
  virtual size_t state_bytes() const = 0;
  /// Levels below the root; 0 without nodes.
  virtual int depth() const { return 0; }
  virtual size_t node_count() const { return 0; }
  /// Calls `visit` for the nodes in depth-first order, parents before children; below a node for
  /// which it returns false nothing is visited. The bound is overwritten after the call, its
  /// triangles are not.
  virtual void visit_nodes(const std::function<bool(const NodeBound&)>& visit) const = 0;
  /// The triangles in the order of the leaves; those of any node are contiguous. Empty without
  /// nodes.
  virtual std::span<const uint32_t> triangle_order() const { return {}; }

  const TriangleMesh& mesh() const { return *mesh_; }
  const std::shared_ptr<const TriangleMesh>& shared_mesh() const { return mesh_; }
  const Aabb& bounds() const { return bounds_; }

  /// Adapts to a deformed mesh with the same triangles and new positions of vertices, in O(n) to
  /// O(n log n), keeping the division into nodes; results are those of a new hierarchy, but slower
  /// if much has moved. Error, and no change, if the triangles differ.
  Status refit(std::shared_ptr<const TriangleMesh> mesh);

  /// Appends the triangles that have a point in common with `box`, ascending.
  virtual void overlap(const Aabb& box, std::vector<uint32_t>& out) const = 0;
  /// First hit with 0 <= t <= t_max; equal t go to the lowest triangle.
  virtual std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const = 0;
  /// Nearest point no further than `max_distance` [m]; equal distances go to the lowest triangle.
  virtual std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const = 0;

  /// Appends the pairs (a of this mesh, b of `other`) that are at most `margin` [m] apart,
  /// ascending. With margin 0 exactly those that have a point in common, the other mesh's vertices
  /// being mapped by the pose and rounded to double.
  virtual void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                     std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const = 0;
  /// Whether pairs() with margin 0 would find any; stops at the first.
  virtual bool intersects(const Hierarchy& other, const Pose& other_pose,
                          HierarchyStatistics* cost = nullptr) const = 0;
  /// Appends the pairs a < b of this mesh's own triangles at most `margin` [m] apart, ascending.
  /// Neighbours, which share a vertex number, are left out: weld the mesh first.
  virtual void self_pairs(double margin, std::vector<TriangleIds>& out,
                          HierarchyStatistics* cost = nullptr) const = 0;
  /// Nearest points of two meshes no further apart than `max_distance` [m]; equal distances go to
  /// the lowest pair.
  virtual std::optional<MeshDistance> distance(const Hierarchy& other, const Pose& other_pose,
                                               double max_distance,
                                               HierarchyStatistics* cost = nullptr) const = 0;
  /// Appends, ascending, the pairs that by their motion bounds may come within the margin of each
  /// other at some time of the motion (swept_triangles_near).
  virtual void swept_pairs(const Hierarchy& other, const SweptQuery& query,
                           std::vector<TriangleIds>& out,
                           HierarchyStatistics* cost = nullptr) const = 0;

 protected:
  explicit Hierarchy(std::shared_ptr<const TriangleMesh> mesh);
  /// Updates the nodes after a change of mesh_ and bounds_.
  virtual void refit_nodes() = 0;

  std::shared_ptr<const TriangleMesh> mesh_;
  Aabb bounds_;
};

/// A kind of hierarchy: its name in files and panels, and how to make one.
struct HierarchyKind {
  std::string_view name;
  std::string_view description;
  std::unique_ptr<Hierarchy> (*make)(std::shared_ptr<const TriangleMesh>, const TreeOptions&);

  std::unique_ptr<Hierarchy> build(std::shared_ptr<const TriangleMesh> mesh,
                                   const TreeOptions& options = {}) const {
    return make(std::move(mesh), options);
  }
};

/// Every kind there is: "aabb", "obb", "sphere", "convex_hull", "brute_force".
const std::vector<HierarchyKind>& all_hierarchies();

}  // namespace tumble
