#pragma once
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/event/event_stepper.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/particles/emitter.hpp"

#include <vector>

namespace tumble {

struct WorldState;

/// Copy of everything that the stages of a stepper change, to be restored if the tick fails.
/// Contact sets keep their own copy of their state before the tick. Memory is reused from tick to
/// tick.
class TickBackup {
 public:
  void take(WorldState& state);
  void restore(WorldState& state);

  std::vector<Pose> poses() const;  ///< by slot
  const Pose& pose(uint32_t slot) const { return bodies_[slot].pose; }
  const std::vector<ParticleSystem>& particles() const { return particles_; }
  void add_memory(MemoryUse& use) const {
    use.bodies += heap_bytes(bodies_);
    use.joints += heap_bytes(joints_, couplings_);
  }

 private:
  struct Motion {
    Pose pose;
    Vec3 v, omega;
    RestWatch rest;
    bool asleep;
  };
  std::vector<Motion> bodies_;
  std::vector<Joint> joints_;
  std::vector<JointCoupling> couplings_;
  std::vector<EventContact> event_contacts_;
  std::vector<ParticleName> event_particles_;
  std::vector<TimeSteppedTicks> time_stepped_;
  std::vector<TimeSteppedParticle> time_stepped_particles_;
  std::vector<ParticleName> touching_particles_;
  std::vector<ParticleSystem> particles_;
  std::vector<Emitter> emitters_;
};

}  // namespace tumble
