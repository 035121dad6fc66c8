#pragma once
#include "engine/collision/motion.hpp"

#include <cstdint>
#include <limits>
#include <span>

namespace tumble {

/// The way of a body through a tick: legs of constant velocity and angular velocity, one after the
/// other. The first is its own; on the later ones it goes on together with what it has met. The
/// frame of each leg is the body's, its carrier what the body goes with. A view.
class Way {
 public:
  /// `later` ascending by the times at which they begin.
  explicit Way(const Motion& own, std::span<const Motion> later = {}) : own_(own), later_(later) {}

  const Motion& own() const { return own_; }
  bool met() const { return !later_.empty(); }
  /// The leg at time t [s]; where two meet, the later one.
  const Motion& leg(double t) const {
    const Motion* at = &own_;
    for (const Motion& m : later_)
      if (m.t0 <= t) at = &m;
    return *at;
  }
  const Motion& last() const { return met() ? later_.back() : own_; }
  Pose pose(double t) const { return leg(t).pose(t); }
  /// When the next leg begins after time t [s]; infinite for the last.
  double next(double t) const {
    for (const Motion& m : later_)
      if (m.t0 > t) return m.t0;
    return std::numeric_limits<double>::infinity();
  }
  /// Whether it moves on after a meeting.
  bool carried() const {
    for (const Motion& m : later_)
      if (moves(m)) return true;
    return false;
  }

  /// Whether it still goes on at time t: on its own, or with something that moves.
  bool moves_at(double t) const {
    const Motion& m = leg(t);
    return &m == &own_ || moves(m);
  }

  static bool moves(const Motion& m) { return !m.velocity.isZero(0) || !m.omega.isZero(0); }

 private:
  const Motion& own_;
  std::span<const Motion> later_;
};

/// What is known of the motion of a body over a tick.
struct Track {
  Motion motion;        ///< its own, as the solver left it
  bool fast = false;    ///< it went farther than it foresees, which dynamic ones do
  bool sweeps = false;  ///< it is fast, or went farther than another foresees
};

}  // namespace tumble
