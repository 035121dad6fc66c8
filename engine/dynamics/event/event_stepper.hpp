#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/crew.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/event/group_windows.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

namespace tumble {

/// How long a body is time-stepped after its group exceeded the budget. An attempt by events costs
/// a good share of the budget, so each further failure doubles the number of ticks without an
/// attempt.
struct TimeSteppedTicks {
  uint8_t left = 0;  ///< ticks still to be time-stepped without an attempt
  uint8_t last = 0;  ///< how many there were after the last failure; 0 after a tick of events

  void fail();
  bool operator==(const TimeSteppedTicks&) const = default;
};

/// The same for a particle.
struct TimeSteppedParticle {
  ParticleName particle;
  TimeSteppedTicks ticks;
};

/// The motion of all bodies over one tick of the `event` stepper: groups of bodies that may meet in
/// it go through their own events, independently of each other. A group whose events cost more work
/// than its budget, or to which an event gives no way on, goes back to the start of the tick and
/// through the whole of it by time-stepping; and since its motion may bring it to where others are,
/// those that it may meet go with it.
class EventStepper {
 public:
  /// Moves all bodies over a tick of h seconds. `links` are what ties bodies together: springs,
  /// joints of the context, couplings. The law and method of `context` are overwritten by those
  /// that its settings name. Sleeping bodies must have been woken. After an error the poses of the
  /// bodies are undefined.
  Status step(std::span<RigidBody> bodies, BroadPhase& broad_phase, std::span<const BodyLink> links,
              const SmoothForces& forces, EventContext context, double h, Crew& crew);

  /// Contacts at the end of the last tick, by group and pair. State: accepted depths and forces
  /// continue from here.
  std::vector<EventContact> contacts;
  /// The particles that slots with particle_bit in `contacts` stand for. State.
  std::vector<ParticleName> particles;
  EventStats stats;  ///< of the last tick
  /// Books of the last tick, by group; empty without EventContext::rates.
  std::vector<GroupBooks> books;

  /// By joint slot: change of its angles in the last tick [rad]; empty for joints that no group
  /// moved by events.
  std::vector<std::optional<std::array<double, most_coordinates>>> turned;

  /// By body slot, with those of particles' blocks; zero beyond the end. State.
  std::vector<TimeSteppedTicks> time_stepped;
  /// The same for particles, between ticks when they have no slots; only those with any. State.
  std::vector<TimeSteppedParticle> time_stepped_particles;

  /// Forgets a body that is removed or replaced.
  void remove_body(uint32_t body);
  /// Writes what the next tick reads.
  void save(ByteWriter& out) const;
  /// False when the bytes are cut short or name a body slot >= `body_slots`.
  bool load(ByteReader& in, uint32_t body_slots);

 private:
  void build_groups(std::span<const RigidBody> bodies, const JointsAndCouplings& held,
                    std::span<const BodyLink> links);
  Status run_groups(std::span<RigidBody> bodies, const SmoothForces& forces,
                    const EventContext& context, double h, Crew& crew);
  Status move_groups(std::span<RigidBody> bodies, const SmoothForces& forces,
                     const EventContext& context, double h, Crew& crew);
  void note_spent();
  Status time_step(std::span<RigidBody> bodies, const EventContext& context);
  void note_time_stepped();
  bool foresee_crowds(const EventContext& context);
  bool widen_reaches();
  void find_pairs(std::span<const RigidBody> bodies, BroadPhase& broad_phase,
                  const PairFilter& apart);
  bool found_all(std::span<const RigidBody> bodies, BroadPhase& broad_phase,
                 const PairFilter& apart);

  std::vector<BodyReach> reaches_;  ///< by slot
  std::vector<BodyMotion> start_;   ///< by slot, at the start of the tick
  std::vector<bool> carried_;       ///< by slot: belongs to a group that is time-stepped
  std::vector<uint64_t> spent_;     ///< by slot: work that is charged to the body in this tick
  WindowReaches window_reaches_;
  ProxySet proxies_;
  std::vector<ProxyPair> pairs_;
  std::vector<BodyGroup> groups_;
  std::vector<EventStats> counted_;  ///< statistics by group
  /// The equations of groups' joints, by the group's first joint; kept to reuse memory, not state.
  std::unordered_map<uint32_t, Articulation> laid_out_;
  std::vector<uint32_t> group_of_, block_of_;  ///< by slot
};

}  // namespace tumble
