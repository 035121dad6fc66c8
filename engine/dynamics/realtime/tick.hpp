#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/profiler.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/bodies/roster.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/realtime/continuous.hpp"
#include "engine/dynamics/realtime/realtime_solver.hpp"
#include "engine/dynamics/realtime/sleeping.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

class TickParts;

/// What the owner of a tick does between its stages: keep books, move what is no rigid body. Ticks
/// with fast thin meshes have several parts, and the stages up to put_back() come in each. Where
/// the ticks of bodies have different numbers of parts, all stages but moved() come for each
/// number, and what has another one is fixed meanwhile (TickParts).
class TickListener {
 public:
  virtual ~TickListener() = default;
  virtual void bounds_known() {}  ///< the broad phase has not looked for pairs yet
  /// Islands have not been made yet. Gives springs that are to be solved with the contacts, between
  /// bodies that RealtimeTick::links make one island; their forces must not be in the sums.
  virtual std::span<SolvedSpring> contacts_known(double /*part*/) { return {}; }
  virtual void islands_known() {}          ///< the solver has not moved anything yet
  virtual void solved(double /*part*/) {}  ///< over so many seconds; nothing has been put back yet
  virtual void put_back() {}               ///< the continuous stage has put something back
  virtual void slept() {}                  ///< some have been put to sleep
  virtual void moved() {}                  ///< the tick is over
};

/// What the stages came to; of several parts the last, where it is no sum.
struct TickReport {
  int parts = 1;                                ///< the greatest number of any body
  uint64_t bounds_tested = 0, pairs_found = 0;  ///< of the broad phase, summed
  std::optional<uint32_t> crowded;  ///< where the tick was refused: slot of a body with most pairs
  ContactUpdateStats contacts;
  RealtimeSolveStats solve;
  ContinuousStats continuous;

  /// Adds what the last parts of some of the bodies came to.
  void add_group(const TickReport& group);
  /// To what all groups came to, whose contacts these are.
  void set_groups(const TickReport& sum, const ContactSet& all);
};

/// A tick of the realtime stepper for rigid bodies: one list of stages for worlds and for tests of
/// the stages. Its owner keeps everything that it works on.
struct RealtimeTick {
  const RealtimeSettings& settings;
  Vec3 gravity;  ///< [m/s2]
  double h;      ///< [s]

  BroadPhase& broad_phase;
  BroadPhase& path_broad_phase;  ///< of the continuous stage, whose bounds differ
  const ContinuousMethods& continuous_methods;
  NarrowPhase narrow_phase;
  const HierarchyKind* hierarchy;  ///< of mesh against mesh; null for the default

  std::vector<RigidBody>& bodies;  ///< with the forces of the tick
  std::span<Joint> joints;
  std::span<JointCoupling> couplings = {};  ///< of these
  std::span<const BodyLink> links;
  std::span<SolvedSpring> springs = {};  ///< TickListener::contacts_known
  const PairFilter& apart;               ///< who passes through each other
  Roster& roster;                        ///< refreshed for this tick
  ProxySet& proxies;
  std::vector<ProxyPair>& pairs;
  ContactSet& contacts;
  IslandSet& islands;
  RealtimeSolver& solver;
  ContinuousStage& continuous;
  SleepScratch& sleep_scratch;

  Crew& crew;
  Profiler& profiler;
  TickListener& listener;
  /// Contacts of all that moves far for its size are found anew within the tick, not only of
  /// meshes.
  bool close = false;
  TickReport report = {};
  double passed = 0;  ///< of the tick, when a part of it begins [s]

  /// All stages; an error where a body stops being finite, where so many bodies are in one place
  /// that their contacts would fill the memory, or where somebody asks to stop.
  Status run();

  // The stages, over h seconds of the tick or of a part of it.
  Status find_pairs(double part);
  void find_contacts(double part, const RealtimeSettings& tuning);
  void group(double part);
  Status solve(double part, const RealtimeSettings& tuning);
  void sweep(double part, const RealtimeSettings& tuning);
  void sleep();

 private:
  Status advance(double part, const RealtimeSettings& tuning);
  Status in_parts(int parts);
  Status group_tick(TickParts& parts, int number);
  Status by_groups(TickParts& parts);
};

}  // namespace tumble
