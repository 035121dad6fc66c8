#pragma once
#include "engine/world/tick_common.hpp"

namespace tumble {

struct WorldState;

/// What particles of systems that are `fast` and collide, and bodies, do to each other: at the end
/// of a tick, when both have moved. Each particle goes straight from where the tick found it and
/// meets bodies on their ways, so that it passes through nothing; there the two exchange one
/// impulse (energetic_impact(), felt at the particle's centre), and the particle spends what is
/// left of the tick as that sends it, at most three times. It is put where what it met has moved
/// meanwhile, which, unlike the impulse, may change the angular momentum: a correction in the
/// books. Particles are taken in the order of their ids, each with the velocities that those before
/// it have left. Sleeping bodies wake only by what would move them faster than bodies sleep. Fast
/// particles do not meet each other.
Status exchange_fast_impulses(WorldState& state, const TickBackup& start);

}  // namespace tumble
