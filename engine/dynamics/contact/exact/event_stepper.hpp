#pragma once
#include "engine/dynamics/contact/exact/event_group.hpp"
#include "engine/dynamics/rigid/islands.hpp"
#include "engine/dynamics/rigid/proxies.hpp"

#include <tbb/task_arena.h>

namespace tumble {

/// The motion of all bodies over one tick of the `event` stepper: groups of bodies that may meet in
/// it go through their own events, independently of each other.
class EventStepper {
 public:
  /// `pairs` are of `proxies`, whose bounds hold the motion of the whole tick; `links` tie bodies
  /// together (springs). `context.law` is filled in. An error leaves the bodies anywhere.
  Status step(std::span<RigidBody> bodies, const ProxySet& proxies,
              std::span<const ProxyPair> pairs, std::span<const BodyLink> links,
              const SmoothForces& forces, EventContext context, double h, tbb::task_arena& arena);

  /// At the end of the last tick, by group and pair. State: offsets and forces continue from here.
  std::vector<EventContact> contacts;
  EventStats stats;  ///< of the last tick

 private:
  void build_groups(std::span<const RigidBody> bodies, const ProxySet& proxies,
                    std::span<const ProxyPair> pairs, std::span<const BodyLink> links);

  std::vector<BodyGroup> groups_;
  std::vector<uint32_t> group_of_, block_of_;  ///< by slot
};

}  // namespace tumble
