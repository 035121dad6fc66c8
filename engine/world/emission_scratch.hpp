#pragma once
#include "engine/dynamics/particles/emitter.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Particles that an event of another one asks for.
struct SpawnCall {
  EmitterId emitter;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();  ///< of the one that asks, then
  double ago = 0;                           ///< before the end of the tick [s]
  int count = 1;
};

/// A body whose collisions are events, and something that presses against it.
struct BodyHit {
  uint32_t slot = 0;
  BodyId other;
  Vec3 x = Vec3::Zero();  ///< where [m]
};

/// Memory of the stage of emission, kept from tick to tick.
struct EmissionScratch {
  std::vector<SpawnCall> calls;
  std::vector<double> births;              ///< times of
  std::vector<uint8_t> hit;                ///< by particle of a system, or by slot of bodies
  std::vector<BodyHit> body_hits;          ///< by slot and other
  std::vector<uint8_t> gone;               ///< likewise
  std::vector<uint32_t> places;            ///< likewise: its index after removal
  std::vector<size_t> counts;              ///< of particles, by system, before the births
  std::vector<ParticleSystem> born, dead;  ///< by system
};

}  // namespace tumble
