#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Of a tick under `realtime`: a kinematic body goes its way whatever holds against it, and may
/// drag or press another one through a fixed body. Says once which, and by whom.
void warn_of_dragged_bodies(WorldState& state);

}  // namespace tumble
