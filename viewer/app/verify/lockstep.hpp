#pragma once
#include "engine/core/result.hpp"
#include "viewer/ui/comparison.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace tumble {

struct Frame;
class World;

/// How far two worlds of one scene are apart at one moment.
struct Divergence {
  double time = 0;  ///< [s]
  uint64_t tick_a = 0, tick_b = 0;
  double distance = 0;    ///< greatest, of centres of mass and particles [m]
  double angle = 0;       ///< greatest, of bodies [rad]
  double speed = 0;       ///< greatest difference of velocities [m/s]
  bool same_bits = true;  ///< of all poses, velocities and places of particles
  std::string what;       ///< where the distance is greatest: "ball", "water particle 12"
};

/// Compares two frames of worlds that were made from the same scene: body by body, those that stand
/// in the same slot under the same name or, where slots differ, by their names; particle by
/// particle. What only one has is infinitely far away.
Divergence divergence(const Frame& a, const Frame& b);

/// The first contact, in the order of bodies, that only one of two frames has, or that presses or
/// gapes otherwise. Its bodies are A's, or those that A calls as B does.
std::optional<ContactDifference> first_contact_difference(const Frame& a, const Frame& b);

/// One of two worlds, and the instruction set that its ticks take (SimdTarget).
struct LockstepSide {
  World& world;
  std::string simd = {};
};

/// Steps two worlds side by side until `seconds`, the one that is behind first, and gives `each`
/// the divergence at every moment that is a tick of both; false ends it. Error: a tick of A or B
/// failed, and which.
Status run_lockstep(const LockstepSide& a, const LockstepSide& b, double seconds,
                    const std::function<bool(const Divergence&)>& each);

}  // namespace tumble
