#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/realtime/tick_parts.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Makes bodies fixed where they are, during its lifetime.
class HeldBodies {
 public:
  explicit HeldBodies(std::span<RigidBody> bodies) : bodies_(bodies) {}
  ~HeldBodies();
  HeldBodies(const HeldBodies&) = delete;
  HeldBodies& operator=(const HeldBodies&) = delete;

  void hold(uint32_t slot);
  /// All dynamic bodies with another number of parts; sleeping ones without a number stay free.
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

/// Lets kinematic bodies move through the tick anew for each number of parts; in the end each is
/// where its own number of parts took it.
class KinematicPaths {
 public:
  KinematicPaths(std::span<RigidBody> bodies, std::span<const uint32_t> active);
  /// Puts them back to the start of the tick.
  void start();
  /// To be called after the parts of this number.
  void keep(const TickParts& parts, int number);
  /// Puts them to the end of the tick.
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
