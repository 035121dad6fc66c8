#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The definition of a described force in a world whose bodies and particles exist. Errors: what it
/// holds on to does not (a copy that is not present).
Result<ForceDef> force_def(const ForceDescription& force, const BuiltScene& built);

/// A particle system with its list and fills. `warnings` receives what could not be done.
/// Errors: too many particles.
Result<ParticleSystemDef> particle_def(const SceneDescription& scene, const std::string& name,
                                       const ParticleSystemDescription& system);

}  // namespace tumble
