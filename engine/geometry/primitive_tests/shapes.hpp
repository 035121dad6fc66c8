#pragma once
#include "engine/math/types.hpp"

#include <array>

namespace tumble {

/// TriangleCorners of a triangle, counter-clockwise seen from outside where a side matters.
/// TriangleCorners may coincide or lie on a line: the triangle is then a segment or a point.
using Triangle3 = std::array<Vec3, 3>;

/// A closed ball. A negative radius (or NaN) makes it empty: it meets nothing.
struct Sphere {
  Vec3 centre = Vec3::Zero();  ///< [m]
  double radius = 0;           ///< [m]
};

/// A closed segment; ends that coincide make it a point.
struct Segment {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< [m]
};

/// A closed box with its own axes: the points centre + sum s_k half_axes.col(k), |s_k| <= 1. The
/// axes are taken as they stand, so that rounding of a rotation leaves a well-defined body: a
/// parallelepiped, flat or without extent where columns are zero or dependent.
struct OrientedBox {
  Vec3 centre = Vec3::Zero();         ///< [m]
  Mat3 half_axes = Mat3::Identity();  ///< columns [m]
};

/// Where two intersecting shapes A and B touch most deeply.
struct PrimitiveContact {
  Vec3 on_a = Vec3::Zero();     ///< point of A's surface, the furthest in B along the normal [m]
  Vec3 on_b = Vec3::Zero();     ///< point of B's surface: on_a - depth * normal [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  /// The shortest translation of B along the normal that leaves the two touching [m], >= 0.
  double depth = 0;
};

}  // namespace tumble
