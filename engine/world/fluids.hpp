#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Moves the particles of all fluids through the tick, one set of interacting fluids
/// (world/fluid_sets) after the other. It runs at the start of the tick, before bodies move and
/// after all forces have been summed: gravity and forces act on the particles as accelerations that
/// are constant over the tick, and bodies stand where they are at its start. The impulse of a fluid
/// on a body acts on it as a constant force over the tick, in the share of the books after those of
/// the forces. Sleeping bodies are fixed walls; a fluid wakes a body that it pushes by more than a
/// tenth of its weight.
Status move_fluids(WorldState& state);

bool is_live_fluid(const WorldState& state, size_t system);

}  // namespace tumble
