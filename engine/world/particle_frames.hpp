#pragma once
#include "engine/dynamics/particles/emitter.hpp"
#include "engine/world/frame.hpp"

#include <functional>

namespace tumble {

/// A live emitter, or null.
using FindEmitter = std::function<const Emitter*(EmitterId)>;

/// What a frame tells of a system, over what `out` held; its id is left alone.
void show_particles(const ParticleSystem& system, const FindEmitter& emitter, ParticleFrame& out);

/// The part of it that depends on the look, for one that may differ from the system's own. A look
/// that finds the range of its colours takes what the system has seen, which is of its own
/// quantity.
void show_particles_as(const ParticleLook& look, const ParticleSystem& system,
                       const FindEmitter& emitter, ParticleFrame& out);

}  // namespace tumble
