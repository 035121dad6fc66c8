#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

/// One triangle as a convex core.
class TriangleCore final : public ConvexCore {
 public:
  TriangleCore(const Vec3& a, const Vec3& b, const Vec3& c) : corner_{a, b, c} {
    for (size_t k = 0; k < 4; ++k) {
      const Vec3& p = corner_[k < 3 ? k : 2];
      for (size_t i = 0; i < 3; ++i) flat_[i][k] = p[int(i)];
    }
    const double reach2 = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
    view_ = CoreView::of_vertices({flat_[0].data(), flat_[1].data(), flat_[2].data(), 4, nullptr},
                                  std::sqrt(reach2), (a + b + c) / 3);
  }
  const Vec3& corner(size_t k) const { return corner_[k]; }

  Vec3 support(const Vec3& d) const override {
    const double h0 = d.dot(corner_[0]), h1 = d.dot(corner_[1]), h2 = d.dot(corner_[2]);
    return h0 >= h1 ? (h0 >= h2 ? corner_[0] : corner_[2]) : (h1 >= h2 ? corner_[1] : corner_[2]);
  }
  /// The triangle, counter-clockwise seen from the side that `direction` points to.
  void supporting_face(const Vec3& direction, SupportingFace& face) const override {
    const Vec3 n = (corner_[1] - corner_[0]).cross(corner_[2] - corner_[0]);
    const bool front = n.dot(direction) >= 0;
    face.count = 0;
    face.add(corner_[0], 0);
    face.add(corner_[front ? 1 : 2], front ? 1 : 2);
    face.add(corner_[front ? 2 : 1], front ? 2 : 1);
  }

 private:
  std::array<Vec3, 3> corner_;
  std::array<std::array<double, 4>, 3> flat_;  ///< x, y and z of the corners, the last twice
};

}  // namespace tumble
