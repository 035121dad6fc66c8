#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Moves the particles of all fluids through the tick, one set of those that see each other
/// (world/fluid_sets) after the other, at its start, before bodies move and when all forces have
/// been summed: gravity and forces act on particles as accelerations that are constant over the
/// tick, and bodies are where they are at its start. What a fluid does to bodies stays over the
/// tick as a force, in a share of the books behind those of the forces. Sleeping bodies are walls
/// to them; those that they push by more than a tenth of a body's own weight wake.
Status move_fluids(WorldState& state);

bool is_live_fluid(const WorldState& state, size_t system);

}  // namespace tumble
