#pragma once
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <algorithm>

namespace tumble {

/// The vertices of a mesh as a convex core: against a half-space only its convex hull matters.
class VertexCore final : public ConvexCore {
 public:
  explicit VertexCore(const TriangleMesh& mesh) : mesh_(mesh) {
    double reach = 0;
    for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.norm());
    view_ = CoreView::of_reach(reach, mesh.vertices[0]);
  }
  Vec3 support(const Vec3& d) const override {
    const Vec3* best = &mesh_.vertices[0];
    double height = d.dot(*best);
    for (const Vec3& v : mesh_.vertices) {
      const double h = d.dot(v);
      if (h > height) height = h, best = &v;
    }
    return *best;
  }
  void supporting_face(const Vec3& d, SupportingFace& face) const override {
    face.count = 0;
    face.add(support(d), 0);
  }

 private:
  const TriangleMesh& mesh_;
};

}  // namespace tumble
