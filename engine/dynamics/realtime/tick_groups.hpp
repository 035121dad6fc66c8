#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/realtime/tick_parts.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Bodies that stand still as fixed ones, where they are, while it lives.
class HeldBodies {
 public:
  explicit HeldBodies(std::span<RigidBody> bodies) : bodies_(bodies) {}
  ~HeldBodies();
  HeldBodies(const HeldBodies&) = delete;
  HeldBodies& operator=(const HeldBodies&) = delete;

  void hold(uint32_t slot);
  /// All dynamic ones whose tick has another number of parts; sleepers that have none are free.
  void hold_others(const TickParts& parts, int number);

 private:
  struct Held {
    uint32_t slot;
    BodyType type;
    Vec3 v, omega;
  };
  std::span<RigidBody> bodies_;
  std::vector<Held> held_;
};

/// Kinematic bodies go their way from the beginning of the tick for each number of parts; where
/// they are in the end is where they came by their own.
class KinematicPaths {
 public:
  KinematicPaths(std::span<RigidBody> bodies, std::span<const uint32_t> active);
  /// Back to the beginning.
  void start();
  /// After the parts of this number.
  void keep(const TickParts& parts, int number);
  /// To the end.
  void finish();

 private:
  struct Path {
    uint32_t slot;
    Pose start, end;
  };
  std::span<RigidBody> bodies_;
  std::vector<Path> paths_;
};

}  // namespace tumble
