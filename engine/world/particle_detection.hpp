#pragma once
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/world/frame.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// Finds what the particles of systems with `detect` touched during a tick (Coutinho 2013 §3.4):
/// each other, and all bodies. Particles and bodies move uniformly from their poses at the start of
/// the tick to those at its end; rotations take the shortest way. Between ticks only scratch memory
/// is kept.
class ParticleDetection {
 public:
  static bool asked_for(std::span<const ParticleSystem> systems);

  /// `start_poses` by body slot and `start` by particle slot are those of the beginning of the tick
  /// of `h` seconds; `bodies` and `systems` those of its end.
  Status find(const BodySet& bodies, std::span<const Pose> start_poses,
              const HandlePool<ParticleSystemTag>& ids, std::span<const ParticleSystem> systems,
              std::span<const ParticleSystem> start, double h, Crew& crew);
  /// Updates contacts after a removal: `places` has the new index of each particle of the system by
  /// its old one; contacts of those that are `gone` are dropped.
  static constexpr uint32_t gone = ~uint32_t{0};
  void renumber(ParticleSystemId system, std::span<const uint32_t> places);
  void clear() { contacts_.reset(); }
  /// Contacts of the last find(), in the form of frames; null after clear().
  const std::shared_ptr<const std::vector<ParticleContactFrame>>& contacts() const {
    return contacts_;
  }

 private:
  struct Owner {
    ParticleSystemId system;
    uint32_t particle;
  };
  struct Part {
    BodyId body;
    uint32_t shape;
  };
  void collect(const BodySet& bodies, std::span<const Pose> start_poses,
               const HandlePool<ParticleSystemTag>& ids, std::span<const ParticleSystem> systems,
               std::span<const ParticleSystem> start, double h);
  Status find_bodies(double h, std::vector<ParticleContactFrame>& out);
  Status find_particles(double h, std::vector<ParticleContactFrame>& out);

  ParticleContactFinder finder_;
  std::vector<Owner> owners_;  ///< of the particles below
  std::vector<Vec3> from_, to_, v_;
  std::vector<double> radius_;
  std::vector<Part> parts_;  ///< of the shapes below
  std::vector<MovingShape> moving_;
  std::vector<StillShape> still_;
  std::shared_ptr<const std::vector<ParticleContactFrame>> contacts_;
};

}  // namespace tumble
