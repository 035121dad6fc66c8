#pragma once
#include "engine/dynamics/event/event_pair.hpp"
#include "engine/dynamics/event/tolerances.hpp"

namespace tumble {

/// Motion of a body as a set of points: rotation of a body of revolution about its own axis moves
/// no points of the set.
struct SwingMotion {
  /// Velocity of the centre of mass, and angular velocity without such rotation, world axes [m/s,
  /// rad/s]
  Vec3 v = Vec3::Zero(), swing = Vec3::Zero();
  double lever = 0;  ///< greatest distance of points from the centre of mass, if they rotate [m]

  SwingMotion() = default;
  explicit SwingMotion(const RigidBody& body);
};

/// Bounds on the relative motion of two bodies over a step, from the velocities at its ends. They
/// hold if accelerations are at most twice their mean over the step, and angular speeds at most a
/// quarter above the greater of those at the ends.
struct RelativeMotion {
  double speed = 0;  ///< of any point of B relative to any of A [m/s]
  double bend = 0;   ///< acceleration of any point of B relative to any of A [m/s2]

  RelativeMotion() = default;
  RelativeMotion(const SwingMotion& a_t0, const SwingMotion& b_t0, const SwingMotion& a_t1,
                 const SwingMotion& b_t1, double step);
};

/// Two convex pieces on their way through a step: whether they overlap deeper than allowed.
///
/// Consider two times Delta apart, with separations f0 along n0 and f1 along n1. Along the
/// direction that is interpolated linearly from n0 to n1, the separation of any two points is a
/// function of time that is at least f0 and f1 at the ends, and whose second derivative is at most
/// bend + 2 |n1 - n0| speed / Delta. So the pieces are never deeper than min(f0, f1) - (bend
/// Delta^2 + 2 |n1 - n0| speed Delta) / 8. Intervals where this bound is too low are subdivided.
class TouchWatch {
 public:
  /// At the bodies' present poses. `hints`: unit normals, world axes, along which the pieces may be
  /// separated. `reach`: how much nearer they may come in the step [m].
  TouchWatch(const EventPair& pair, const PiecePair& pieces, std::span<const RigidBody> bodies,
             std::span<const Vec3> hints, double reach);

  bool near() const { return near_; }  ///< whether the pieces are within reach at the start
  void set_motion(const RelativeMotion& m) { motion_ = m; }
  const EventPair& pair() const { return *pair_; }

  enum class Look : uint8_t { clear, open, touched };
  /// Examines the bodies' present poses, `since` seconds after the time that was last passed.
  Look look(std::span<const RigidBody> bodies, double since);
  /// Makes the poses of the last look(), which must have been clear, the start of the next
  /// interval.
  void pass() { passed_ = last_; }
  /// Distance to the greatest allowed depth at the bodies' present poses [m].
  double room_now(std::span<const RigidBody> bodies) const;
  double room_passed() const { return passed_.room; }

 private:
  struct State {
    Pose a, b;  ///< poses of the bodies
    Vec3 normal;
    double room;  ///< distance to the greatest allowed depth, along the normal [m]
  };
  double separation(std::span<const RigidBody> bodies, const Vec3& n) const;

  const EventPair* pair_;
  PiecePair pieces_;
  RelativeMotion motion_;
  double allowed_ = tolerances::deepest_unseen, dip_ = tolerances::deepest_dip;
  bool near_ = true;
  State passed_, last_;
};

}  // namespace tumble
