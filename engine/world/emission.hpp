#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// A live emitter made from a definition that validate() accepts.
Result<Emitter> make_emitter(const EmitterDef& def, double time);
/// Reserves memory in the arrays of every system for all particles that its emitters may have alive
/// at once.
void reserve_for_emitters(WorldState& state);

/// The stage at the end of a tick: removes particles that reached the end of their life or a sink,
/// creates the particles due by events, rates and bursts, and sets sizes and colours by age.
/// `start` holds the state at the beginning of the tick.
Status emit_particles(WorldState& state, const TickBackup& start);

/// Before a tick: removes bodies that reached the end of their life or a sink, and creates those
/// that are due in the tick. A second call for the same tick does nothing. Returns whether anything
/// was done.
Result<bool> emit_bodies(WorldState& state);

/// Whether a later tick may create or remove anything, so that a world in which nothing moves has
/// to go on.
bool emission_to_come(const WorldState& state);

}  // namespace tumble
