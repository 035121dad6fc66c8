#pragma once
#include "engine/dynamics/particles/emitter.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A request for births, made by an event of another particle.
struct SpawnCall {
  EmitterId emitter;
  /// Of the particle that asks, at the time of the event [m], [m/s].
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();
  double ago = 0;  ///< time of the event, before the end of the tick [s]
  int count = 1;
};

/// A body whose collisions are events, and something that presses against it or is so near that it
/// goes on touching what it touched.
struct BodyHit {
  uint32_t slot = 0;
  BodyId other;
  bool presses = true;
  Vec3 x = Vec3::Zero();  ///< where [m]
};

/// Scratch memory of the emission stage, kept from tick to tick.
struct EmissionScratch {
  std::vector<SpawnCall> calls;
  std::vector<double> births;      ///< times of births within the tick [s]
  std::vector<uint8_t> hit;        ///< by particle of a system, or by slot of bodies: met something
  std::vector<BodyHit> body_hits;  ///< by slot and other
  std::vector<uint8_t> gone;       ///< likewise: why it is removed, 0 if it stays
  std::vector<uint32_t> places;    ///< likewise: its index after removal
  std::vector<size_t> counts;      ///< of particles, by system, before the births
  std::vector<ParticleSystem> born, dead;  ///< by system
  /// By system: copies of particles that live on, each with the mass that it lost or gained.
  std::vector<ParticleSystem> shed, gained;
};

}  // namespace tumble
