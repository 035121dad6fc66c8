#pragma once
#include "engine/geometry/hierarchy/aabb_kind.hpp"
#include "engine/geometry/hierarchy/hull_separation.hpp"

namespace tumble {

/// All points within `radius` of the convex hull of some of the node's vertices; and their box.
struct HullVolume : AabbVolume {
  float radius;          ///< rounded up
  uint32_t first_point;  ///< in HullKind::vertices()
  uint32_t point_count;
};

/// Rounded convex hulls. A node of few vertices keeps all of them, with a radius near zero; a
/// larger one keeps those that are extreme along 26 directions, and its radius is the distance of
/// the vertex farthest outside their hull, so that the volume contains all.
///
/// Boxes are used for rays, points and boxes; hulls separate pairs of nodes that boxes cannot.
class HullKind {
 public:
  using Volume = HullVolume;
  static constexpr const char* name = "convex_hull";
  static constexpr size_t max_points = 26;

  size_t state_bytes() const { return vertices_.size() * sizeof(uint32_t); }
  void fit(const FitInput& in, std::vector<TreeNode<HullVolume>>& nodes);
  /// Numbers of the mesh's vertices, by node.
  const std::vector<uint32_t>& vertices() const { return vertices_; }

  template <class Tree>
  void bound(const Tree& tree, const HullVolume& v, NodeBound& out) const {
    out.form = BoundForm::hull;
    out.points.clear();
    for (uint32_t k = 0; k < v.point_count; ++k)
      out.points.push_back(tree.mesh().vertices[vertices_[v.first_point + k]]);
    out.radius = double(v.radius);
  }

  static float size_of(const AabbVolume& v) { return AabbKind::size_of(v); }
  static double furthest(const AabbVolume& v, const Vec3& p) { return AabbKind::furthest(v, p); }
  using BoxTest = AabbKind::BoxTest;
  using RayTest = AabbKind::RayTest;
  using PointTest = AabbKind::PointTest;

  template <bool swept>
  class PairTest {
   public:
    template <class Tree>
    PairTest(const Tree& a, const Tree& b, const RelativePose& at, double margin, const Vec3& sweep)
        : boxes_(a, b, at, margin, sweep),
          kind_a_(a.kind()),
          kind_b_(b.kind()),
          mesh_a_(a.mesh()),
          mesh_b_(b.mesh()),
          at_(at),
          sweep_(sweep),
          margin_(margin),
          slack_(pair_slack(a, b, at.point(b.origin()) - a.origin(), at)) {}

    bool apart(const HullVolume& a, const HullVolume& b, double extra = 0) const {
      if (boxes_.apart(a, b, extra)) return true;
      const double reach = double(a.radius) + double(b.radius) + margin_ + slack_ + extra;
      return hulls_apart(kind_a_.points(mesh_a_, a, {}), moved(b), reach);
    }
    float squared_distance(const HullVolume& a, const HullVolume& b) const {
      const double far = hull_distance(kind_a_.points(mesh_a_, a, {}), moved(b)).lower;
      const double d = far - double(a.radius) - double(b.radius) - slack_;
      return std::max(boxes_.squared_distance(a, b), d > 0 ? lower_bound(d * d) : 0);
    }

   private:
    std::vector<Vec3> moved(const HullVolume& b) const {
      std::vector<Vec3> out = kind_b_.points(mesh_b_, b, at_);
      if (swept) {
        for (size_t k = 0, n = out.size(); k < n; ++k) out.push_back(out[k] + sweep_);
      }
      return out;
    }

    AabbKind::PairTest<swept> boxes_;
    const HullKind &kind_a_, &kind_b_;
    const TriangleMesh &mesh_a_, &mesh_b_;
    RelativePose at_;
    Vec3 sweep_;
    double margin_, slack_;
  };

  /// The points of a node, placed.
  std::vector<Vec3> points(const TriangleMesh& mesh, const HullVolume& v,
                           const RelativePose& at) const {
    std::vector<Vec3> out;
    out.reserve(2 * v.point_count);
    for (uint32_t k = 0; k < v.point_count; ++k) {
      out.push_back(at.point(mesh.vertices[vertices_[v.first_point + k]]));
    }
    return out;
  }

 private:
  std::vector<uint32_t> vertices_;
};

}  // namespace tumble
