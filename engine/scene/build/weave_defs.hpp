#pragma once
#include "engine/dynamics/forces/weave.hpp"
#include "engine/scene/build.hpp"

namespace tumble {

/// A weave that waits for its particles to be in the world.
struct WaitingWeave {
  std::string system;  ///< name of the particle system
  std::string name;    ///< of the force: "flag.cloth", "bridge.rope[2]"
  Weave weave;
  uint64_t first = 1;       ///< id of its first particle
  double break_strain = 0;  ///< [-]
};

/// The systems through whose particles ropes of a system run, each as often as they do.
std::vector<std::string> systems_on_ropes(const ParticleSystemDescription& system);

/// The particle systems in the order in which they can be made: as in the file, but behind those
/// through which their ropes run. Error: ropes lead from a system back to it.
Result<std::vector<std::string>> particle_order(const SceneDescription& scene);

/// Adds the particles of the cloths, nets and ropes of a system to its definition, which may have
/// `budget` in all, and gives what is to be tied once they are there. Bodies that hold them exist.
/// Errors: with their place.
Result<std::vector<WaitingWeave>> add_weaves(const std::string& name,
                                             const ParticleSystemDescription& system, double budget,
                                             const BuiltScene& built, ParticleSystemDef& out);

}  // namespace tumble
