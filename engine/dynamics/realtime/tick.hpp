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

/// Work of the owner of a tick between its stages: energy books, and whatever is not a rigid body.
/// A tick with fast thin meshes has several parts, and the calls up to put_back() come in each of
/// them. Where bodies have different numbers of parts, all calls but moved() come once for each
/// number, and bodies with another number are fixed meanwhile (TickParts).
class TickListener {
 public:
  virtual ~TickListener() = default;
  virtual void bounds_known() {}  ///< before the broad phase searches for pairs
  /// Before islands are built. Returns springs that are to be solved with the contacts, between
  /// bodies that RealtimeTick::links put in one island; their forces must not be in the sums.
  virtual std::span<SolvedSpring> contacts_known(double /*part*/) { return {}; }
  virtual void islands_known() {}  ///< before the solver moves anything
  /// After the solver moved bodies for so many seconds, before any is moved back.
  virtual void solved(double /*part*/) {}
  /// The continuous stage moved bodies back, or along with kinematic ones.
  virtual void put_back(const ContinuousStage& /*stage*/) {}
  virtual void slept() {}  ///< islands were put to sleep
  virtual void moved() {}  ///< the tick is over
};

/// Results of the stages; of several parts the sum where that makes sense, otherwise the last.
struct TickReport {
  int parts = 1;                                ///< greatest number of parts of any body
  uint64_t bounds_tested = 0, pairs_found = 0;  ///< of the broad phase, summed
  /// If the tick was refused because of too many pairs: slot of a body in most of them.
  std::optional<uint32_t> crowded;
  ContactUpdateStats contacts;
  RealtimeSolveStats solve;
  ContinuousStats continuous;

  /// Adds the results of the bodies with one number of parts.
  void add_group(const TickReport& group);
  /// Sets the results of the whole tick from the sum over all numbers, and all contacts.
  void set_groups(const TickReport& sum, const ContactSet& all);
};

/// A tick of the realtime stepper for rigid bodies: one list of stages for worlds and for tests.
/// Its owner keeps all the data that it works on.
struct RealtimeTick {
  const RealtimeSettings& settings;
  Vec3 gravity;  ///< [m/s2]
  double h;      ///< length of the tick [s]

  BroadPhase& broad_phase;
  BroadPhase& path_broad_phase;  ///< for the continuous stage, whose bounds differ
  const ContinuousMethods& continuous_methods;
  NarrowPhase narrow_phase;
  const HierarchyKind* hierarchy;  ///< for mesh against mesh; null for the default

  std::vector<RigidBody>& bodies;  ///< with the forces of the tick set
  std::span<Joint> joints;
  std::span<JointCoupling> couplings = {};  ///< of these joints
  std::span<const BodyLink> links;
  std::span<SolvedSpring> springs = {};  ///< as TickListener::contacts_known() returned them
  const PairFilter& apart;               ///< pairs of bodies that pass through each other
  Roster& roster;                        ///< up to date for this tick
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
  /// Kinematic bodies whose velocity changes within the tick, by slot. RigidBody::v and omega are
  /// its means, over the tick before and after run(), over the present part within it.
  std::span<const CourseMotion> courses = {};
  /// Contacts of all bodies that move far for their size, not only of meshes, are found anew within
  /// the tick.
  bool close = false;
  TickReport report = {};
  double passed = 0;  ///< time of the tick at which the present part begins [s]

  /// Runs all stages. Error if a body becomes non-finite, if so many bodies are in one place that
  /// their contacts would fill the memory, or if a stop is requested.
  Status run();

  // The stages, over `part` seconds: the tick or a part of it.
  Status find_pairs(double part);
  void find_contacts(double part, const RealtimeSettings& tuning);
  void group(double part);
  Status solve(double part, const RealtimeSettings& tuning);
  void sweep(double part, const RealtimeSettings& tuning);
  void sleep();

 private:
  void wake_beside_carried();
  void set_courses(double t);
  Status advance(double part, const RealtimeSettings& tuning);
  Status in_parts(int parts);
  Status group_tick(TickParts& parts, int number);
  Status by_groups(TickParts& parts);
};

}  // namespace tumble
