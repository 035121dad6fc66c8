#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Effect of a cause on grains and bodies in a tick.
struct GrainEffect {
  double work = 0;  ///< [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
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
};

}  // namespace tumble
