#pragma once
#include "engine/dynamics/grains/grain_bodies.hpp"
#include "engine/dynamics/grains/grain_bundles.hpp"
#include "engine/dynamics/grains/grain_memory.hpp"
#include "engine/dynamics/grains/grain_report.hpp"
#include "engine/dynamics/grains/grain_rest.hpp"
#include "engine/dynamics/grains/solve_grains.hpp"

#include <vector>

namespace tumble {

/// Moves grains by one tick of the realtime stepper (README.md). What the next tick needs is stored
/// in the systems and in the touches; members are scratch memory.
class GrainStage {
 public:
  static bool asked_for(const HandlePool<ParticleSystemTag>& ids,
                        std::span<const ParticleSystem> systems);
  /// To be called before the bodies move: applies to bodies the impulses that grains gave them in
  /// the last tick, up to their weight, as a prediction. step() takes it back and applies the
  /// actual impulses. Without the prediction a body that lies on grains would fall a little in
  /// every tick.
  void carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h) {
    bodies_.carry(touches, bodies, gravity, h);
  }
  std::span<const GrainLoad> carried() const { return bodies_.carried(); }
  Status step(const GrainTick& tick, GrainTouches& touches, GrainReport& report);

 private:
  void wake_lost(const GrainTick& tick, const GrainTouches& touches);
  void wake_again(const GrainTick& tick, size_t i);
  int parts_of(const GrainTick& tick) const;
  Status part(const GrainTick& tick, GrainTouches& touches, double t0, double t1, int substeps,
              GrainReport& report);
  void find_touched(Crew* crew);
  void count(Crew* crew, const GrainPairWork& work, GrainReport& report) const;
  void age(const GrainTick& tick) const;

  GrainField grains_;
  GrainPairs finder_;
  NearShapes shapes_;
  GrainPairList pairs_;
  GrainBundles bundles_;
  GrainMotion motion_;
  GrainBodies bodies_;
  GrainMemory memory_;
  GrainRestWatch rest_;
  std::vector<NearShapes::Touch> touching_;
  std::vector<uint8_t> touched_;
  std::vector<Vec3> from_, start_;
};

}  // namespace tumble
