#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The definition of a described force in a world whose bodies and particles exist. Errors: what it
/// holds on to does not (a copy that is not present).
Result<ForceDef> force_def(const ForceDescription& force, const BuiltScene& built);

/// A particle system with its list and fills, which may have `budget` particles. Errors: more.
Result<ParticleSystemDef> particle_def(const SceneDescription& scene, const std::string& name,
                                       const ParticleSystemDescription& system, double budget);

}  // namespace tumble
