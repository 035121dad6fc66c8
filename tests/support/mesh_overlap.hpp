#pragma once
// How far two triangulated solids overlap, found without the narrow phase: points spread over the
// surface of one (corners, edges) that are inside the other by rays, and their distance to its
// surface. Resolution: overlap between sample points is missed up to about half their spacing
// times the sine of the angle of the surfaces there.
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace tumble::test {

/// A closed mesh with points on its surface.
class OverlapProbe {
 public:
  /// Points lie at most `spacing` [m] apart along edges.
  OverlapProbe(const TriangleMesh& mesh, double spacing)
      : mesh_(std::make_shared<const TriangleMesh>(mesh)), tree_(mesh_) {
    points_ = mesh.vertices;
    for (const Triangle& t : mesh.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t i = t[k], j = t[(k + 1) % 3];
        if (i > j) continue;  // the neighbour brings this edge
        const Vec3 &p = mesh.vertices[i], &q = mesh.vertices[j];
        const int n = int(std::ceil((q - p).norm() / spacing));
        for (int s = 1; s < n; ++s) points_.push_back(p + (double(s) / n) * (q - p));
      }
    }
  }

  /// Depth of a point below the surface, 0 outside [m].
  double depth(const Vec3& x) const {
    const Aabb& box = tree_.bounds();
    if ((x.array() < box.min.array()).any() || (x.array() > box.max.array()).any()) return 0;
    // The first face that a ray meets shows its back to a point inside; two of three rays decide.
    int inside = 0;
    for (const Vec3& d :
         {Vec3(0.577, 0.211, -0.789), Vec3(-0.318, 0.883, 0.344), Vec3(0.129, -0.469, 0.873)}) {
      const auto hit = tree_.ray({x, d}, 1e3);
      inside += hit && !hit->front;
    }
    if (inside < 2) return 0;
    const auto near = tree_.closest(x, 1e3);
    return near ? std::sqrt(near->squared_distance) : 0;
  }

  const std::vector<Vec3>& points() const { return points_; }
  double radius() const {
    double r = 0;
    for (const Vec3& p : mesh_->vertices) r = std::max(r, p.norm());
    return r;
  }

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  AabbTree tree_;
  std::vector<Vec3> points_;
};

/// Greatest depth of a point of A inside B or of B inside A [m].
inline double overlap(const OverlapProbe& a, const Pose& pose_a, const OverlapProbe& b,
                      const Pose& pose_b) {
  double deepest = 0;
  const auto probe = [&](const OverlapProbe& from, const Pose& in_to, const OverlapProbe& to) {
    for (const Vec3& p : from.points()) deepest = std::max(deepest, to.depth(in_to.point(p)));
  };
  probe(a, pose_b.inverse() * pose_a, b);
  probe(b, pose_a.inverse() * pose_b, a);
  return deepest;
}

}  // namespace tumble::test
