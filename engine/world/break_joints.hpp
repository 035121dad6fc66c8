#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Before a tick: joints that may move have done nothing in it yet.
void begin_joints(WorldState& state);
/// After a tick: coordinates are followed where no solver did it, and joints that bore more in its
/// mean than they can are removed, as by commands that no log holds.
Status end_joints(WorldState& state);

}  // namespace tumble
