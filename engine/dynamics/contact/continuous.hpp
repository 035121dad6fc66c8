#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/dynamics/contact/realtime_settings.hpp"
#include "engine/dynamics/rigid/body.hpp"
#include "engine/dynamics/rigid/proxies.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <tbb/task_arena.h>

namespace tumble {

struct ContinuousStats {
  uint64_t fast = 0;     ///< bodies that moved farther than their inner radius
  uint64_t tested = 0;   ///< pairs of shapes whose time of contact was computed
  uint64_t stopped = 0;  ///< bodies held back at a contact
};

/// Swept detection after the solver. Bodies that moved farther in the tick than their inner radius
/// (rotation included) are taken back to just before the first contact on their way; their velocity
/// stays, so that the next tick resolves the contact. Both bodies of a pair may be fast.
class ContinuousStage {
 public:
  /// Keeps the poses at the start of the tick; call before the solver.
  void remember(std::span<const RigidBody> bodies);
  /// Takes back the poses of fast bodies; call after the solver.
  ContinuousStats apply(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h,
                        const RealtimeSettings& settings, tbb::task_arena& arena);

 private:
  std::vector<Pose> start_;
  ProxySet proxies_;
  std::vector<ProxyPair> pairs_;
};

}  // namespace tumble
