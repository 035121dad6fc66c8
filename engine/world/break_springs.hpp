#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Springs of meshes that are stretched too far at the end of a tick break: they, the bends over
/// them, and the faces and strands that they drew are gone. The energy that they held is booked on
/// the line of their force.
void break_springs(WorldState& state);

}  // namespace tumble
