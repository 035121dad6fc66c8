#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The definition of a described force in a world whose bodies and particles exist. Errors:
/// something that it is attached to does not exist (a copy that is not present).
Result<ForceDef> force_def(const ForceDescription& force, const BuiltScene& built);

/// An end of a force, in a world whose bodies and particles exist, at its position at the start.
Result<Anchor> anchor_of(const AnchorDescription& end, const BuiltScene& built);
Vec3 start_of(const Anchor& end, const World& world);

/// The ids with a name, including all copies that are present, in the order of the copies.
std::vector<BodyId> bodies_named(const std::string& name, const BuiltScene& built);

/// The springs between neighbouring particles of a system, in the order of the particles. Errors:
/// more than 100000.
Result<std::vector<SpringDef>> neighbour_springs(const NeighbourSpringsDescription& springs,
                                                 ParticleSystemId id, const ParticleSystem& system);

/// A particle system with its list and fills, of at most `budget` particles. Errors: more.
Result<ParticleSystemDef> particle_def(const SceneDescription& scene, const std::string& name,
                                       const ParticleSystemDescription& system, double budget);

}  // namespace tumble
