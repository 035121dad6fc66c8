#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

/// Before the bodies have their tick: grains that carried them go on (GrainStage::carry).
void carry_on_grains(World::State& state);

/// Moves the grains of a tick whose bodies have moved (`dynamics/grains`), and books what that did:
/// contacts under restitution and friction, what no cause explains under projection.
Status step_grains(World::State& state, const TickBackup& start);

}  // namespace tumble
