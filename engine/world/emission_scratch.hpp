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

/// Scratch memory of the emission stage, kept from tick to tick.
struct EmissionScratch {
  std::vector<SpawnCall> calls;
  std::vector<double> births;  ///< times of births within the tick [s]
  /// By particle of a system: whether it met something in the tick.
  std::vector<uint8_t> hit;
  /// By particle of a system: why it is removed, 0 if it stays.
  std::vector<uint8_t> gone;
  std::vector<uint32_t> places;            ///< by particle of a system: its index after the removal
  std::vector<size_t> counts;              ///< number of particles before the births, by system
  std::vector<ParticleSystem> born, dead;  ///< by system
};

}  // namespace tumble
