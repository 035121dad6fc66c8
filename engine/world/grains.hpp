#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

/// Moves the grains of a tick whose bodies have moved (`dynamics/grains`), and books what that did:
/// contacts under restitution and friction, what no cause explains under projection.
Status step_grains(World::State& state, const TickBackup& start);

}  // namespace tumble
