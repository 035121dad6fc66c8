#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

Aabb ConvexShape::bounds(const Pose& pose) const {
  const Mat3 R = pose.q.toRotationMatrix();
  Aabb box;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = R.row(k).transpose();  // the world axis in the shape's frame
    box.max[k] = pose.x[k] + axis.dot(support(axis)) + rounding();
    box.min[k] = pose.x[k] + axis.dot(support(-axis)) - rounding();
  }
  return box;
}

SurfaceElement ConvexShape::border_at(const Vec3& point, const Vec3& outward) const {
  return {ElementKind::point, point - rounding() * outward, Vec3::UnitY(), rounding()};
}

std::optional<SurfacePoint> ConvexShape::nearest(const Vec3&) const {
  return std::nullopt;
}

}  // namespace tumble
