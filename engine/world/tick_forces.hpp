#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// The smooth forces of one tick at any moment of it, as the event stepper asks for them. Particles
/// move once a tick: their forces, and what they do to bodies, are found at its start and stay.
class TickForces {
 public:
  /// Sets the forces on all particles.
  explicit TickForces(World::State& state);

  /// Sets force and torque of the given bodies at t seconds after the start of the tick. Groups of
  /// bodies that no spring ties to each other may be asked for at the same time.
  void operator()(double t, std::span<const uint32_t> bodies) const;

 private:
  void assign_anchored(uint32_t force);

  World::State& state_;
  std::vector<uint32_t> fields_;                 ///< slots of forces on everything
  std::vector<std::vector<uint32_t>> anchored_;  ///< by body slot: forces that it answers for
  std::vector<std::pair<Vec3, Vec3>> held_;      ///< by body slot: force and torque by particles
};

}  // namespace tumble
