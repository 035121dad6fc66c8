#pragma once
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace tumble {

/// A scalar equation C = 0 of a joint.
struct JointRow {
  Row row;           ///< Jacobian of C: dC/dt = J v
  double error = 0;  ///< C [m] or [rad]
  double bias = 0;   ///< dJ/dt v, so that d2C/dt2 = J a + bias [m/s2] or [rad/s2]
};

/// The rows of one joint, at most one for each of the six degrees of freedom.
class JointRows {
 public:
  static constexpr size_t most = 6;
  void push_back(const JointRow& row) {
    assert(count_ < most);
    rows_[count_++] = row;
  }
  void clear() { count_ = 0; }
  /// Place for writing further rows; end_at() then says where they end.
  JointRow* end() { return rows_.data() + count_; }
  void end_at(const JointRow* end) {
    count_ = size_t(end - rows_.data());
    assert(count_ <= most);
  }
  size_t size() const { return count_; }
  const JointRow& operator[](size_t i) const { return rows_[i]; }
  std::span<const JointRow> all() const { return {rows_.data(), count_}; }

 private:
  size_t count_ = 0;
  std::array<JointRow, most> rows_;
};

/// One body's end of a joint at the present, in world axes; the world is at rest and has no block.
struct JointSide {
  uint32_t block = no_block;
  Vec3 x = Vec3::Zero();         ///< centre of mass [m]
  Vec3 v = Vec3::Zero();         ///< [m/s]
  Vec3 omega = Vec3::Zero();     ///< [rad/s]
  Vec3 arm = Vec3::Zero();       ///< from the centre of mass to the joint's anchor [m]
  Quat q = Quat::Identity();     ///< of the joint's frame on this body
  Mat3 axes = Mat3::Identity();  ///< the same as a matrix: columns are the frame's axes

  Vec3 anchor() const { return x + arm; }
  Vec3 anchor_velocity() const { return v + omega.cross(arm); }
  /// Acceleration of the anchor by rotation at a constant rate [m/s2].
  Vec3 anchor_bias() const { return omega.cross(omega.cross(arm)); }
};

/// Both ends of a joint. Relative quantities are those of B relative to A.
struct JointSides {
  JointSide a, b;
  double length = 0;  ///< of a distance joint [m]
};

/// Writes a part's rows from `out` on, and returns the place behind them. Joints are composed of
/// these parts, each in a file of its own.
using JointPart = JointRow* (*)(const JointSides& sides, JointRow* out);

/// The anchors coincide: three rows along the world axes.
JointRow* anchors_together(const JointSides& sides, JointRow* out);
/// The z axes of both frames are parallel: two rows, z of B against x and y of A.
JointRow* axes_aligned(const JointSides& sides, JointRow* out);
/// The z axis of A's frame and the x axis of B's are perpendicular: one row.
JointRow* axes_perpendicular(const JointSides& sides, JointRow* out);
/// The frames do not rotate relative to each other: three rows, twice the vector part of the
/// relative quaternion in A's axes.
JointRow* no_rotation(const JointSides& sides, JointRow* out);
/// B's anchor is on the line through A's along the z axis of A's frame: two rows.
JointRow* anchor_on_line(const JointSides& sides, JointRow* out);
/// B's anchor is in the plane through A's anchor perpendicular to the z axis of A's frame: one row.
JointRow* anchor_in_plane(const JointSides& sides, JointRow* out);
/// The anchors are `length` apart: one row. If they coincide, along the z axis of A's frame.
JointRow* anchors_apart(const JointSides& sides, JointRow* out);

}  // namespace tumble
