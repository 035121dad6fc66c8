#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// The motion of a frame during [t0, t1]: its carrier (a body's centre of mass) has constant
/// velocity and constant angular velocity, and the frame is rigidly attached to it.
///
/// Guarantees that nothing is passed through refer to this motion.
struct Motion {
  Pose start;                    ///< of the carrier at t0
  Vec3 velocity = Vec3::Zero();  ///< of the carrier [m/s]
  Vec3 omega = Vec3::Zero();     ///< world axes [rad/s]
  double t0 = 0, t1 = 0;         ///< [s]
  Pose offset;                   ///< the frame relative to the carrier

  /// Pose of the carrier at time t.
  Pose carrier(double t) const;
  /// Pose of the frame at time t.
  Pose pose(double t) const { return carrier(t) * offset; }

  /// Greatest distance from the carrier's centre of any point within `radius` of the frame's
  /// origin [m]; constant over the motion.
  double lever(double radius) const { return offset.x.norm() + radius; }
  /// Bound on the speed of any point within `lever` of the carrier's centre [m/s].
  double speed_bound(double lever) const;
  /// Bound on the velocity along unit vector `n` of any such point, at any time [m/s]: for a point
  /// p about the centre, n.(v + omega x p) <= n.v + |n x omega| |p|.
  double speed_bound_along(const Vec3& n, double lever) const;

  /// Velocity of the frame's origin at time t [m/s].
  Vec3 origin_velocity(double t) const;
  /// Speed of the frame's origin relative to the carrier's centre [m/s]; constant over the motion.
  /// Its acceleration is |omega| times that.
  double orbit_speed() const { return omega.cross(start.direction(offset.x)).norm(); }

  /// Standing still.
  static Motion at_rest(const Pose& pose, double t0, double t1);
  /// From `from` at t0 to `to` at t1, with constant velocity and the shortest rotation.
  static Motion between(const Pose& from, const Pose& to, double t0, double t1);
};

/// Bound on the distance between an arc of `angle` >= 0 [rad] and `radius`, and its chord [m]; a
/// point that rotates and translates at constant velocities deviates from its chord by no more.
double arc_height(double angle, double radius);

}  // namespace tumble
