#pragma once
#include "engine/dynamics/event/search_trace.hpp"
#include "engine/dynamics/sph/fluid_solver.hpp"

namespace tumble {

/// What a tick writes down about how it was computed, for whoever asks by World::watch_with(). It
/// changes nothing, and is no part of the state.
struct TickWatch {
  BodyId body;                ///< null, or whose group's searches for events are wanted
  EventSearchTrace searches;  ///< of the last tick; empty where no event stepper moved the body
  ParticleSystemId fluid;     ///< null, or whose pressures are wanted
  FluidTrace pressures;       ///< of the last sub-step of the last tick
};

}  // namespace tumble
