#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// One tick of the `event` stepper: the list of its stages.
Status step_event(WorldState& state);

}  // namespace tumble
