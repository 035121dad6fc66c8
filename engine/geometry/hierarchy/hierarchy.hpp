#pragma once
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <memory>
#include <optional>
#include <string_view>

namespace tumble {

/// First hit of a ray with a mesh.
struct MeshRayHit {
  double t = 0;  ///< in lengths of the ray's direction
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

/// A triangle of one mesh and one of another (or of the same).
struct TriangleIds {
  uint32_t a, b;
  friend bool operator==(TriangleIds, TriangleIds) = default;
  friend auto operator<=>(TriangleIds, TriangleIds) = default;
};

/// What a query cost.
struct HierarchyStatistics {
  size_t node_tests = 0;
  size_t triangle_tests = 0;
};

/// Finds triangles of one mesh quickly. Every kind gives exactly the same answers, brute force
/// included, because what is reported is decided triangle by triangle by functions that all kinds
/// share; nodes only leave out what those would refuse. So switching the kind changes no result.
///
/// Built over a mesh that passed validate(); it shares ownership of it. Queries are const and may
/// run in many threads at once.
class Hierarchy {
 public:
  virtual ~Hierarchy() = default;

  virtual std::string_view name() const = 0;
  /// Memory of the structure without the mesh [bytes].
  virtual size_t state_bytes() const = 0;

  const TriangleMesh& mesh() const { return *mesh_; }
  const Aabb& bounds() const { return bounds_; }

  /// Appends the triangles whose bounding box overlaps `box` (touching counts), ascending.
  virtual void overlap(const Aabb& box, std::vector<uint32_t>& out) const = 0;
  /// First hit with 0 <= t <= t_max; equal t go to the lowest triangle.
  virtual std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const = 0;
  /// Nearest point no further than `max_distance` [m]; equal distances go to the lowest triangle.
  virtual std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const = 0;
  /// Appends the pairs (a of this mesh, b of `other`) whose bounding boxes are at most `margin` [m]
  /// apart along each axis, both when taken in this mesh's frame and in the other's; ascending.
  /// A pair of triangles nearer than `margin` is never missed. `other_pose` maps the other mesh's
  /// frame to this one.
  virtual void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                     std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const = 0;

 protected:
  explicit Hierarchy(std::shared_ptr<const TriangleMesh> mesh);

  std::shared_ptr<const TriangleMesh> mesh_;
  Aabb bounds_;
};

/// One kind of hierarchy: its name in files and panels, and how to make one.
struct HierarchyKind {
  std::string_view name;
  std::string_view description;
  std::unique_ptr<Hierarchy> (*build)(std::shared_ptr<const TriangleMesh>);
};

/// Every kind there is: "aabb", "brute_force".
const std::vector<HierarchyKind>& all_hierarchies();

/// The test that decides Hierarchy::pairs: whether the bounding boxes of triangle `a` and triangle
/// `b`, the latter mapped by `pose`, are within `margin` along each axis of either frame.
bool triangle_boxes_near(const TriangleMesh& mesh_a, uint32_t a, const TriangleMesh& mesh_b,
                         uint32_t b, const Pose& pose, double margin);

}  // namespace tumble
