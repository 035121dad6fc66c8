#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// How a frame moves during [t0, t1]: its carrier (a body's centre of mass) at constant velocity
/// and constant angular velocity, the frame itself rigidly attached to it.
///
/// What is said never to pass through anything is this motion.
struct Motion {
  Pose start;                    ///< of the carrier at t0
  Vec3 velocity = Vec3::Zero();  ///< of the carrier [m/s]
  Vec3 omega = Vec3::Zero();     ///< world axes [rad/s]
  double t0 = 0, t1 = 0;         ///< [s]
  Pose offset;                   ///< the frame relative to the carrier

  /// The carrier at time t.
  Pose carrier(double t) const;
  /// The frame at time t.
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
  /// How fast the frame's origin goes round the carrier [m/s]; constant over the motion. Its
  /// acceleration is |omega| times that.
  double orbit_speed() const { return omega.cross(start.direction(offset.x)).norm(); }

  /// Standing still.
  static Motion at_rest(const Pose& pose, double t0, double t1);
  /// From `from` at t0 to `to` at t1: straight, and turning the shortest way.
  static Motion between(const Pose& from, const Pose& to, double t0, double t1);
};

/// How far an arc of `angle` >= 0 [rad] about a centre at `radius` may be from the straight line
/// between its ends [m]: what turns and moves on at constant velocity leaves its chord by no more.
double arc_height(double angle, double radius);

}  // namespace tumble
