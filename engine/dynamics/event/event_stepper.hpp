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

/// What a body remembers of ticks that were too much for its group. Trying costs a good share of
/// the budget, so each time it fails again twice as many ticks are time-stepped without a try.
struct TimeSteppedTicks {
  uint8_t left = 0;  ///< to be time-stepped without a try
  uint8_t last = 0;  ///< how many they were the last time; 0 after a tick of events

  void fail();
  bool operator==(const TimeSteppedTicks&) const = default;
};

/// The same of a particle.
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
  /// `links` tie bodies together: springs, joints of the context, what couples these. `context`
  /// needs no laws: they are those of its settings. Sleeping bodies must be awake. An error leaves
  /// the bodies anywhere.
  Status step(std::span<RigidBody> bodies, BroadPhase& broad_phase, std::span<const BodyLink> links,
              const SmoothForces& forces, EventContext context, double h, Crew& crew);

  /// At the end of the last tick, by group and pair. State: offsets and forces continue from here.
  std::vector<EventContact> contacts;
  /// Particles that `contacts` name by their place here, with particle_bit. State.
  std::vector<ParticleName> particles;
  EventStats stats;  ///< of the last tick
  /// Of the last tick, by group; empty without EventContext::rates.
  std::vector<GroupBooks> books;

  /// Of the last tick, by joint slot: by how much its angles changed [rad]; nothing of joints that
  /// no group moved by events.
  std::vector<std::optional<std::array<double, most_coordinates>>> turned;

  /// By body slot, those of particles' blocks with them; bodies behind the end have none. State.
  std::vector<TimeSteppedTicks> time_stepped;
  /// Between ticks, when they have no slots: of the particles that have any. State.
  std::vector<TimeSteppedParticle> time_stepped_particles;

  /// Drops what is known of a body that is removed or replaced.
  void remove_body(uint32_t body);
  /// What the next tick reads.
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
  std::vector<BodyMotion> start_;   ///< of the tick, by slot
  std::vector<bool> carried_;       ///< by slot: belongs to a group that is time-stepped
  std::vector<uint64_t> spent_;     ///< by slot: of the work in this tick
  WindowReaches window_reaches_;
  ProxySet proxies_;
  std::vector<ProxyPair> pairs_;
  std::vector<BodyGroup> groups_;
  std::vector<EventStats> counted_;  ///< by group
  /// The equations of groups' joints, by the first of these; memory, no state.
  std::unordered_map<uint32_t, Articulation> laid_out_;
  std::vector<uint32_t> group_of_, block_of_;  ///< by slot
};

}  // namespace tumble
