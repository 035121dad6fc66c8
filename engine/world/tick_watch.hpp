#pragma once
#include "engine/dynamics/event/search_trace.hpp"
#include "engine/dynamics/sph/fluid_solver.hpp"

namespace tumble {

/// Record of how a tick was computed, made on request (World::watch_with). It changes nothing, and
/// is not part of the state.
struct TickWatch {
  BodyId body;  ///< null, or the body whose group's searches for events are recorded
  /// Of the last tick; empty if the event stepper did not move the body.
  EventSearchTrace searches;
  ParticleSystemId fluid;  ///< null, or the system whose pressure solves are recorded
  FluidTrace pressures;    ///< of the last sub-step of the last tick
};

}  // namespace tumble
