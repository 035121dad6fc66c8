#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Removes springs of meshes that are stretched too far at the end of a tick, together with the
/// bending springs over them and the faces and strands drawn between them. The energy that they
/// stored is booked on the ledger line of their force.
void break_springs(WorldState& state);

}  // namespace tumble
