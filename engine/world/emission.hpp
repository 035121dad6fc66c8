#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// A live emitter of a definition that validate() accepts.
Result<Emitter> make_emitter(const EmitterDef& def, double time);
/// Room in the arrays of every system for all that its emitters may have alive at once.
void reserve_for_emitters(WorldState& state);

/// The stage at the end of a tick: particles that reached the end of their life or a sink are
/// removed, what events, rates and bursts ask for is born, and sizes and colours follow the age.
/// `start` is the beginning of the tick.
Status emit_particles(WorldState& state, const TickBackup& start);

/// Before a tick: bodies that reached the end of their life or a sink are removed, those that are
/// due in the tick are made. Does nothing when done again for the same tick. Tells whether it did.
Result<bool> emit_bodies(WorldState& state);

/// Whether a tick may bring something into a world in which nothing moves.
bool emission_to_come(const WorldState& state);

}  // namespace tumble
