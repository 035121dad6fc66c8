#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tumble {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;
using Vec3f = Eigen::Vector3f;
using Vec4f = Eigen::Vector4f;
/// Rotation from body to world axes, unit length. Constructor order is (w, x, y, z).
using Quat = Eigen::Quaterniond;

/// A rigid frame in world axes: x_world = x + R(q) x_body.
struct Pose {
  Vec3 x = Vec3::Zero();      ///< origin [m]
  Quat q = Quat::Identity();  ///< orientation, unit quaternion

  /// Maps a point of the body frame to the world.
  Vec3 point(const Vec3& p_body) const { return x + q._transformVector(p_body); }
  Vec3 direction(const Vec3& d_body) const { return q._transformVector(d_body); }
  /// Maps a world point to the body frame.
  Vec3 inverse_point(const Vec3& p_world) const {
    return q.conjugate()._transformVector(p_world - x);
  }
  Vec3 inverse_direction(const Vec3& d_world) const {
    return q.conjugate()._transformVector(d_world);
  }
  /// The pose of a child frame given relative to this one.
  Pose operator*(const Pose& child) const { return {point(child.x), q * child.q}; }
  Pose inverse() const { return {q.conjugate()._transformVector(-x), q.conjugate()}; }
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
