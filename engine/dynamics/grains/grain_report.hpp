#pragma once
#include "engine/math/types.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tumble {

/// Effect of a cause on grains and bodies in a tick.
struct GrainEffect {
  double work = 0;  ///< [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();

  void add(const GrainEffect& e) {
    work += e.work;
    momentum += e.momentum;
    angular_momentum += e.angular_momentum;
  }
};

struct GrainReport {
  bool moved = false;  ///< false: all grains sleep, and nothing came near them
  bool woke_bodies = false;
  size_t awake = 0, contacts = 0;
  size_t held = 0;     ///< grains that would have passed into a shape and were stopped
  double deepest = 0;  ///< greatest overlap [m]
  GrainEffect restitution, friction, kinematic, sleeping;
  /// A body whose velocities changed, with the velocities before.
  struct Pushed {
    uint32_t slot;
    Vec3 v, omega;
  };
  std::vector<Pushed> bodies;  ///< by ascending slot

  /// Adds the effects of another report, which concern other contacts.
  void add_effects(const GrainReport& other) {
    restitution.add(other.restitution);
    friction.add(other.friction);
    kinematic.add(other.kinematic);
    deepest = std::max(deepest, other.deepest);
  }
};

}  // namespace tumble
