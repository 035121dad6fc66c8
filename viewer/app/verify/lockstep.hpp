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

/// Distance between two worlds of one scene at one time.
struct Divergence {
  double time = 0;  ///< [s]
  uint64_t tick_a = 0, tick_b = 0;
  double distance = 0;    ///< greatest distance of centres of mass or particles [m]
  double angle = 0;       ///< greatest angle between orientations of a body [rad]
  double speed = 0;       ///< greatest difference of velocities [m/s]
  bool same_bits = true;  ///< all poses, velocities and particle positions are bitwise equal
  std::string what;       ///< what has the greatest distance: "ball", "water particle 12"
};

/// Compares two frames of worlds made from the same scene: bodies that have the same slot and name
/// or, where slots differ, the same name; particle by particle. The distance of what only one of
/// them has is infinite.
Divergence divergence(const Frame& a, const Frame& b);

/// The first contact, in the order of bodies, that only one of two frames has, or whose impulse or
/// gap differs. Its bodies are A's, matched by name to B's.
std::optional<ContactDifference> first_contact_difference(const Frame& a, const Frame& b);

/// One of two worlds, and the instruction set for its ticks (SimdTarget).
struct LockstepSide {
  World& world;
  std::string simd = {};
};

/// Steps two worlds side by side up to `seconds`, always the one that is behind, and calls `each`
/// with the divergence at every time at which both have a tick; false ends the run. Error: a tick
/// failed, naming A or B.
Status run_lockstep(const LockstepSide& a, const LockstepSide& b, double seconds,
                    const std::function<bool(const Divergence&)>& each);

}  // namespace tumble
