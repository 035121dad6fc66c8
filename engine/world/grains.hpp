#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

struct WorldState;

/// Before the bodies have their tick: grains that carried them go on (GrainStage::carry).
void carry_on_grains(WorldState& state);

/// Moves the grains of a tick whose bodies have moved (`dynamics/grains`), and books what that did:
/// contacts under restitution and friction, what no cause explains under projection.
Status step_grains(WorldState& state, const TickBackup& start);

}  // namespace tumble
