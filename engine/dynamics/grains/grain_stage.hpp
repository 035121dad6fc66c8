#pragma once
#include "engine/dynamics/grains/grain_bodies.hpp"
#include "engine/dynamics/grains/grain_bundles.hpp"
#include "engine/dynamics/grains/grain_memory.hpp"
#include "engine/dynamics/grains/grain_report.hpp"
#include "engine/dynamics/grains/grain_rest.hpp"
#include "engine/dynamics/grains/solve_grains.hpp"

#include <vector>

namespace tumble {

/// Moves grains by one tick of the realtime stepper (README.md). What a tick needs of the one
/// before is in the systems and in the touches; the rest is memory.
class GrainStage {
 public:
  static bool asked_for(const HandlePool<ParticleSystemTag>& ids,
                        std::span<const ParticleSystem> systems);
  /// Before the bodies have their tick: they are carried by what grains gave them in the last one,
  /// up to their weight, as if it went on. step() takes it back and gives what they give now.
  /// Without it a body on grains would fall a little in every tick.
  void carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h) {
    bodies_.carry(touches, bodies, gravity, h);
  }
  std::span<const GrainLoad> carried() const { return bodies_.carried(); }
  Status step(const GrainTick& tick, GrainTouches& touches, GrainReport& report);

 private:
  void wake_lost(const GrainTick& tick, const GrainTouches& touches);
  void wake_again(const GrainTick& tick, size_t i);
  double closing_speed() const;
  Status part(const GrainTick& tick, GrainTouches& touches, double t0, double t1, int substeps,
              GrainReport& report);
  void find_touched();
  void count(const GrainPairWork& work, GrainReport& report) const;
  void age(const GrainTick& tick) const;

  GrainField grains_;
  GrainPairs finder_;
  NearShapes shapes_;
  GrainPairList pairs_;
  GrainBundles bundles_;
  GrainBodies bodies_;
  GrainMemory memory_;
  GrainRestWatch rest_;
  std::vector<NearShapes::Touch> touching_;
  std::vector<uint8_t> touched_;
  std::vector<Vec3> from_, start_;
};

}  // namespace tumble
