#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// The particles that contacts with bodies pressed in the tick before, for the springs of meshes.
/// Who was pressed from several sides is taken as stuck, and by what dynamic body as moving with it
/// where that is much heavier; light bodies hold nothing.
void find_held_particles(const WorldState& state, std::vector<HeldParticle>& out);

/// All pairs that do not collide with each other while blocks are there: what joints tie together,
/// and the two ends of each link of a mesh, which would wedge each other apart where a cloth is
/// pressed together along its threads.
void find_apart(WorldState& state, PairFilter& out);

}  // namespace tumble
