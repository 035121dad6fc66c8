#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

namespace tumble {

/// Makes `to` a copy of `from`, with room for as many particles, on these threads. `from` is the
/// same afterwards.
void copy_particles(ParticleSystem& from, ParticleSystem& to, Crew* crew);

}  // namespace tumble
