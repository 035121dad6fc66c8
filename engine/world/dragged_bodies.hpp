#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// For a tick under `realtime`: a kinematic body follows its course whatever resists it, and may
/// drag or press another body through a fixed one. Warns of that once in the life of a world, with
/// the names of all three.
void warn_of_dragged_bodies(WorldState& state);

}  // namespace tumble
