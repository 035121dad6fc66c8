#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// One tick of the `realtime` stepper: the list of its stages.
Status step_realtime(WorldState& state);

}  // namespace tumble
