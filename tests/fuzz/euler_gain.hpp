#pragma once
#include "engine/world/frame.hpp"

#include <vector>

namespace tumble {

/// The energy that explicit Euler makes, as its formula says. A step from (x, v) to (x + h v, v + h
/// a) makes h^2/2 (a M a + v V'' v), to second order, where M is the mass matrix and V the
/// potential: a fall from rest has n^2/2 m g^2 h^2 after n steps, of which n/2 m g^2 h^2 are made.
/// While something swings both terms are alike in the mean, so that twice the first is allowed.
/// Where joints bend the way, a is the whole acceleration: a pendulum's centripetal one makes it go
/// faster and faster. Steps that are shorter than the tick make less.
class EulerGain {
 public:
  explicit EulerGain(const Frame& start) { remember(start); }

  /// Adds a tick's, with h a from how velocities changed. Impacts change them too: a tick with some
  /// makes as much as the last one without.
  void add_tick(const Frame& frame) {
    if (frame.stats.impacts == 0 && frame.stats.time_stepped == 0) {
      of_tick_ = 0;
      for (size_t i = 0; i < frame.body_slots(); ++i) of_tick_ += of_body(frame, i);
    }
    total_ += of_tick_;
    remember(frame);
  }
  double total() const { return total_; }  ///< [J]

 private:
  double of_body(const Frame& frame, size_t i) const {
    const BodyInfo& info = frame.info(i);
    if (info.type != BodyType::dynamic || i >= before_.size()) return 0;
    const BodyFrame& now = frame.body(i);
    const Vec3 gained = now.v - before_[i].v;
    const Vec3 turned = now.pose.inverse_direction(now.omega - before_[i].omega);
    return info.mass * gained.squaredNorm() + turned.dot(info.inertia * turned);
  }
  void remember(const Frame& frame) {
    before_.clear();
    for (size_t i = 0; i < frame.body_slots(); ++i) before_.push_back(frame.body(i));
  }

  std::vector<BodyFrame> before_;
  double of_tick_ = 0, total_ = 0;  // [J]
};

}  // namespace tumble
