#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// What a failed tick must give back: everything that the stages of a stepper change. Contacts
/// remember by themselves what they were when the tick began.
class TickBackup {
 public:
  explicit TickBackup(World::State& state);
  void restore(World::State& state);

  std::vector<Pose> poses() const;  ///< by slot
  const std::vector<ParticleSystem>& particles() const { return particles_; }

 private:
  struct Motion {
    Pose pose;
    Vec3 v, omega;
    RestWatch rest;
    bool asleep;
  };
  std::vector<Motion> bodies_;
  std::vector<Joint> joints_;
  std::vector<EventContact> event_contacts_;
  std::vector<ParticleName> event_particles_;
  std::vector<ParticleName> touching_particles_;
  std::vector<ParticleSystem> particles_;
};

/// What ties bodies together besides contacts: springs, then joints.
std::vector<BodyLink> body_links(const World::State& state);
/// The same with springs on particles that are blocks now.
std::vector<BodyLink> block_links(World::State& state);

/// "body 'NAME' (slot N)"; particles that are blocks have a name too.
std::string body_label(const World::State& state, uint32_t slot);

/// Names the first body or particle whose state is not finite.
Status check_finite(const World::State& state);

/// The stage that moves particles that are no blocks by the forces on them.
void integrate_particles(World::State& state);

/// Contacts of particles over the tick that has just been computed.
Status detect_particle_contacts(World::State& state, const TickBackup& start);

}  // namespace tumble
