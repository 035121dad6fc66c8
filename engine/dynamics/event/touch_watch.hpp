#pragma once
#include "engine/dynamics/event/event_pair.hpp"
#include "engine/dynamics/event/tolerances.hpp"

namespace tumble {

/// How a body moves as a set of points: what spins about the axis that it is round about stays
/// where it is.
struct SwingMotion {
  Vec3 v = Vec3::Zero(), swing = Vec3::Zero();  ///< world axes [m/s, rad/s]
  double lever = 0;                             ///< of what swings [m]

  SwingMotion() = default;
  explicit SwingMotion(const RigidBody& body);
};

/// Bounds on the motion of two bodies relative to each other over a step, from the velocities at
/// its ends: true as long as accelerations are no more than twice their mean over the step, and
/// angular speeds no more than a quarter above both ends'.
struct RelativeMotion {
  double speed = 0;  ///< of any point of B against any of A [m/s]
  double bend = 0;   ///< acceleration of any such point [m/s2]

  RelativeMotion() = default;
  RelativeMotion(const SwingMotion& a_t0, const SwingMotion& b_t0, const SwingMotion& a_t1,
                 const SwingMotion& b_t1, double step);
};

/// Two convex pieces on their way through a step: whether they come in deeper than allowed.
///
/// Between two looks Delta apart, with separations f0 along n0 and f1 along n1, the separation of
/// any two points along the direction that goes straight from n0 to n1 is a function of time that
/// is at least f0 and f1 at the ends, and whose second derivative is at most bend + 2 |n1 - n0|
/// speed / Delta: so the pieces are nowhere deeper than min(f0, f1) - (bend Delta^2 + 2 |n1 - n0|
/// speed Delta) / 8. What that does not clear is looked at more closely.
class TouchWatch {
 public:
  /// At the bodies' present poses. `hints`: unit normals, world axes, that may part the two.
  TouchWatch(const EventPair& pair, const PiecePair& pieces, std::span<const RigidBody> bodies,
             std::span<const Vec3> hints, double reach);

  bool near() const { return near_; }  ///< within reach at the start
  void set_motion(const RelativeMotion& m) { motion_ = m; }
  const EventPair& pair() const { return *pair_; }

  enum class Look : uint8_t { clear, open, touched };
  /// Looks at the bodies' present poses, `since` seconds after the last time that was passed.
  Look look(std::span<const RigidBody> bodies, double since);
  /// Takes the last look, which must have been clear, for passed.
  void pass() { passed_ = last_; }
  /// What is left until the two are deeper than allowed, at the bodies' present poses [m].
  double room_now(std::span<const RigidBody> bodies) const;
  double room_passed() const { return passed_.room; }

 private:
  struct State {
    Pose a, b;  ///< of the bodies
    Vec3 normal;
    double room;  ///< along the normal [m]
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
