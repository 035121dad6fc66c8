#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/event/body_clusters.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/watched_pair.hpp"

#include <array>

namespace tumble {

/// Reaches of bodies in windows, by how often the tick was halved for them, and slot; and how
/// finely they went lately.
struct WindowReaches {
  std::array<std::vector<BodyReach>, tolerances::most_window_halvings + 1> by_depth;
  /// By slot: steps a second that the body's cluster took when it last went through a window as a
  /// whole, or tried to; 0 at the start of a tick.
  std::vector<double> pace;
  /// For all slots of a world, none of which reaches anywhere yet.
  void reset(size_t slots);
};

/// A group of many bodies over a part of a tick of the event stepper. What closed contacts, joints
/// and springs tie together has to move together; other bodies do so only while they may meet. So
/// every body gets a reach for the part, bodies that may meet within theirs are a cluster, and
/// every cluster goes through the part by itself, with its own steps and events (EventGroup),
/// several at a time on the threads of the crew. Where many would move together that nothing ties
/// to each other, a cluster goes through either half of the part in turn, with reaches and clusters
/// of its own there, and so on: so bodies that are close to each other divide their time finely,
/// and what flies alone need not.
///
/// A body may go farther than was foreseen. Only where it could then have met what it did not
/// reckon with do both go through the part again, together.
class GroupWindows {
 public:
  /// Whether a group is worth it: clusters at the start of the tick as far as known from its ties
  /// and contacts.
  static bool scattered(const BodyGroup& group, const EventContext& context);

  /// `block_of`: by slot the body's place in the group; will be that in its cluster. `reaches`: of
  /// its bodies they are the group's to write, from `depth` on, how often the tick was halved.
  GroupWindows(std::span<RigidBody> bodies, BodyGroup& group, std::span<uint32_t> block_of,
               WindowReaches& reaches, const SmoothForces& forces, const EventContext& context,
               Crew& crew, int depth = 0);

  /// As EventGroup::advance().
  Status advance(const TickPart& part, EventStats& stats);

 private:
  struct Cluster {
    BodyGroup group;
    std::vector<size_t> pairs;  ///< of the group's
    bool crowd = false;         ///< goes through the window in parts, unless little happens
    EventStats stats;
    Status status;
    bool done = false;
  };

  Status run_window(const TickPart& part, EventStats& stats);
  void guess_reaches(const TickPart& part);
  void find_clusters();
  /// Whether the gap of a pair is no more than a distance [m], at the start of a window.
  bool within(WatchedPair& w, double distance);
  bool may_meet(WatchedPair& w);
  double max_displacement(const WatchedPair& w) const;
  /// What went through the window with the same bodies and pairs need not do so again.
  void make_clusters();
  void fill(Cluster& cluster) const;
  void run(Cluster& cluster, const TickPart& part);
  /// False where halves of the part are better.
  bool run_whole(Cluster& cluster, const TickPart& part);
  bool takes_few_steps(const Cluster& cluster, double seconds) const;
  void note_pace(const Cluster& cluster, double seconds);
  void start_again(Cluster& cluster);
  void put_bodies(std::span<const BodyMotion> motions);
  std::vector<BodyMotion> motions() const;
  void foresee_crowds();
  /// By place: how far bodies went in the window [m].
  std::vector<double> gone_in_window() const;
  /// Whether bodies went farther than they were to, and so far that they could have met what they
  /// were not to; they get the reaches that they need. The bodies must be where they started.
  bool missed_any(std::span<const double> gone_now);
  void commit(EventStats& stats);
  Error too_much() const;
  void add_books(const Cluster& cluster);

  std::span<RigidBody> bodies_;
  BodyGroup& group_;
  std::span<uint32_t> block_of_;
  WindowReaches& all_reaches_;
  std::span<BodyReach> reaches_;
  const SmoothForces& forces_;
  const EventContext& context_;
  Crew& crew_;
  int depth_;
  std::vector<WatchedPair> pairs_;
  std::vector<Vec3> halves_;                         ///< by place: BodyReach::half
  std::vector<double> gone_;                         ///< by place, over the windows [m]
  std::vector<uint32_t> joint_place_;                ///< of a body of each joint
  std::vector<uint32_t> coupling_place_;             ///< of a body of each coupling
  std::vector<std::pair<uint32_t, uint32_t>> ties_;  ///< places
  BodyClusters together_;
  std::vector<BodyMotion> start_, end_;  ///< of the window, by place; `end_` of what is done
  std::vector<Cluster> clusters_;        ///< by their least body
};

}  // namespace tumble
