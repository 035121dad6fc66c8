#pragma once
#include "engine/math/array3.hpp"
#include "engine/math/matrix3.hpp"
#include "engine/math/quaternion.hpp"
#include "engine/math/vector.hpp"

#include <limits>

namespace tumble {

using Vec2 = Vector2<double>;
using Vec3 = Vector3<double>;
using Vec4 = Vector4<double>;
using Mat3 = Matrix3<double>;
using Vec2f = Vector2<float>;
using Vec3f = Vector3<float>;
using Vec4f = Vector4<float>;
using Mat3f = Matrix3<float>;
/// Rotation from body to world axes, unit length. Constructor order is (w, x, y, z).
using Quat = Quaternion<double>;

/// A rigid frame in world axes: x_world = x + R(q) x_body.
struct Pose {
  Vec3 x = Vec3::Zero();      ///< origin [m]
  Quat q = Quat::Identity();  ///< orientation, unit quaternion

  /// Maps a point of the body frame to the world.
  Vec3 point(const Vec3& p_body) const { return x + q * p_body; }
  Vec3 direction(const Vec3& d_body) const { return q * d_body; }
  /// Maps a world point to the body frame.
  Vec3 inverse_point(const Vec3& p_world) const { return q.conjugate() * (p_world - x); }
  Vec3 inverse_direction(const Vec3& d_world) const { return q.conjugate() * d_world; }
  /// The pose of a child frame given relative to this one.
  Pose operator*(const Pose& child) const { return {point(child.x), q * child.q}; }
  Pose inverse() const { return {q.conjugate() * (-x), q.conjugate()}; }
};

/// Axis-aligned box; empty while min > max.
struct Aabb {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void include(const Aabb& b) {
    min = min.cwiseMin(b.min);
    max = max.cwiseMax(b.max);
  }
  Aabb inflated(double d) const { return {min.array() - d, max.array() + d}; }
  bool overlaps(const Aabb& b) const {
    return (min.array() <= b.max.array()).all() && (b.min.array() <= max.array()).all();
  }
  bool contains(const Vec3& p) const {
    return (min.array() <= p.array()).all() && (p.array() <= max.array()).all();
  }
  bool empty() const { return (min.array() > max.array()).any(); }
  Vec3 centre() const { return 0.5 * (min + max); }
  Vec3 extent() const { return max - min; }
};

}  // namespace tumble
