#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// The particles that contacts with bodies pressed in the tick before, for the springs of meshes.
/// Who was pressed from several sides is taken as stuck, and by what dynamic body as moving with it
/// where that is much heavier; light bodies hold nothing.
void find_held_particles(const World::State& state, std::vector<HeldParticle>& out);

}  // namespace tumble
