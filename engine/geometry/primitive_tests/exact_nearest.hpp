#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <vector>

namespace tumble {

/// A corner, edge or face of a polytope with exact coordinates: `corner` is the sum of its terms;
/// `u` and `v` are differences first - second. A face is {corner + s u + t v} with s, t in [0, 1],
/// or with s, t >= 0, s + t <= 1 when it is a triangle.
struct ExactFeature {
  int dimension = 0;  ///< 0 corner, 1 edge along u, 2 face
  bool triangle = false;
  std::array<Vec3, 4> corner{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, 2> u{Vec3::Zero(), Vec3::Zero()}, v{Vec3::Zero(), Vec3::Zero()};
};

/// Faces, edges, corners, in this order.
std::vector<ExactFeature> features_of(const Segment& segment);
std::vector<ExactFeature> features_of(const Triangle3& triangle);
std::vector<ExactFeature> features_of(const OrientedBox& box);

/// Whether some feature is within `radius` of p, exactly. The distance of a polytope from a point
/// outside is that of the nearest feature whose inside holds the point's projection.
bool within(const Vec3& p, double radius, const std::vector<ExactFeature>& features);

/// The vector from the nearest feature to p; every coordinate has full relative accuracy, however
/// near the two are.
Vec3 accurate_offset(const Vec3& p, const std::vector<ExactFeature>& features);

}  // namespace tumble
