#pragma once
#include "engine/dynamics/grains/grain_bodies.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_report.hpp"

#include <vector>

namespace tumble {

/// Which grains go to sleep.
class GrainRestWatch {
 public:
  /// At the end of a tick, which began with the grains at `start`: updates how long each grain has
  /// been slow, and puts grains to sleep that have been slow for `sleep_time` and touch nothing
  /// that has been slow for less than half of it.
  void watch(const GrainTick& tick, GrainField& grains, std::span<const Vec3> start,
             const GrainPairList& pairs, std::span<const GrainForces> forces,
             const GrainBodies& bodies, GrainReport& report);

 private:
  /// What a grain touches: something that is asleep, fixed or slow for long enough (firm);
  /// something else (restless).
  enum Hold : uint8_t { none = 0, firm = 1, restless = 2 };
  bool time_slow(const GrainTick& tick, const GrainField& grains, std::span<const Vec3> start);
  void find_held(const GrainTick& tick, const GrainField& grains, const GrainPairList& pairs,
                 std::span<const GrainForces> forces, const GrainBodies& bodies);

  std::vector<uint8_t> restless_;  ///< by place: awake, and not slow for half the time of sleep
  std::vector<uint8_t> hold_;      ///< by place: bits of Hold
};

}  // namespace tumble
