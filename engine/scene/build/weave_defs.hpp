#pragma once
#include "engine/dynamics/forces/weave.hpp"
#include "engine/scene/build.hpp"

namespace tumble {

/// A weave whose particles have yet to be created in the world.
struct WaitingWeave {
  std::string system;  ///< name of the particle system
  std::string name;    ///< of the force: "flag.cloth", "bridge.rope[2]"
  Weave weave;
  uint64_t first = 1;       ///< id of its first particle
  double break_strain = 0;  ///< [-]
};

/// The systems through whose particles ropes of a system run, once for each rope.
std::vector<std::string> systems_on_ropes(const ParticleSystemDescription& system);

/// The particle systems in an order in which they can be created: as in the file, but after those
/// through which their ropes run. Error: ropes form a cycle of systems.
Result<std::vector<std::string>> particle_order(const SceneDescription& scene);

/// Adds the particles of the cloths, nets and ropes of a system to its definition, of at most
/// `budget` in all, and returns the weaves to be connected when the particles exist. The bodies
/// that hold them must exist. Errors: with their place.
Result<std::vector<WaitingWeave>> add_weaves(const std::string& name,
                                             const ParticleSystemDescription& system, double budget,
                                             const BuiltScene& built, ParticleSystemDef& out);

}  // namespace tumble
