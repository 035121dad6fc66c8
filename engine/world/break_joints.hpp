#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Before a tick: sets the impulses of joints between awake bodies, and the count of broken joints,
/// to zero.
void begin_joints(WorldState& state);
/// After a tick: updates the coordinates of joints where no solver did, and removes joints whose
/// mean load over the tick exceeded their strength. The removal works as a command does, but is not
/// logged.
Status end_joints(WorldState& state);

}  // namespace tumble
