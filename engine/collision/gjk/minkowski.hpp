#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// A core placed in the frame of a query (world axes, any origin near the pair, so that distances
/// do not lose digits far from the world's origin).
struct PlacedCore {
  const ConvexCore* core = nullptr;
  Mat3 R = Mat3::Identity();
  Vec3 x = Vec3::Zero();

  PlacedCore() = default;
  PlacedCore(const ConvexCore& c, const Quat& q, const Vec3& origin)
      : core(&c), R(q.toRotationMatrix()), x(origin) {}

  Vec3 support(const Vec3& d) const { return x + R * core->support(R.transpose() * d); }
  Vec3 centre() const { return x + R * core->centre(); }
  /// The supporting face, mapped to the frame of the query.
  void supporting_face(const Vec3& d, SupportingFace& face) const {
    core->supporting_face(R.transpose() * d, face);
    for (int i = 0; i < face.count; ++i) {
      Vec3& p = face.points[size_t(i)];
      p = x + R * p;
    }
  }
};

/// A point of the Minkowski difference A - B, with the points of A and B that make it.
struct DifferencePoint {
  Vec3 w, a, b;
};

inline DifferencePoint support(const PlacedCore& A, const PlacedCore& B, const Vec3& d) {
  const Vec3 a = A.support(d), b = B.support(-d);
  return {a - b, a, b};
}

}  // namespace tumble
