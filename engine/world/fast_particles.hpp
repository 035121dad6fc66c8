#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

struct WorldState;

/// The impulses between bodies and the colliding particles of `fast` systems, at the end of a tick,
/// when both have moved. Each particle moves straight from its position at the start of the tick
/// and is tested against the moving bodies, so that it passes through nothing. At a collision the
/// two exchange one impulse (energetic_impact(), applied at the particle's centre), and the
/// particle spends the rest of the tick with its new velocity, at most three times. Its position is
/// then corrected to where the body that it met is at the end of the tick; unlike the impulse this
/// may change the angular momentum, and is booked as a correction. Particles are processed in the
/// order of their ids, each with the velocities that those before it have left. A sleeping body
/// wakes only if the impulse gives it more than the speed at which bodies fall asleep. Fast
/// particles do not collide with each other.
Status exchange_fast_impulses(WorldState& state, const TickBackup& start);

}  // namespace tumble
