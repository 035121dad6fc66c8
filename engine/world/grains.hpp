#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

struct WorldState;

/// Before the tick of the bodies: bodies that rest on grains get the support that these gave them
/// in the last tick (GrainStage::carry).
void carry_on_grains(WorldState& state);

/// Moves the grains of a tick whose bodies have moved already (`dynamics/grains`), and books their
/// work: contacts under `restitution` and `friction`, the unexplained rest under `projection`.
Status step_grains(WorldState& state, const TickBackup& start);

}  // namespace tumble
