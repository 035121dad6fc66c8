#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Limit of the particles of one system, those emitted by events included, and of the bodies that
/// an emitter makes in a tick; more end the run [-].
constexpr size_t most_of_a_system = 20'000'000;

/// Number of births due by rate and bursts at a time [s] of the emitter, since the time to which it
/// has emitted.
double due_by(const Emitter& e, double time);

/// The error for more than most_of_a_system, before memory for them is allocated.
Error too_many(const WorldState& s, const Emitter& e);

}  // namespace tumble
