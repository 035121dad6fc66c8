#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/event/body_clusters.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/watched_pair.hpp"

#include <array>

namespace tumble {

/// Reaches of bodies in windows, by number of halvings of the tick and by slot; and how many steps
/// their clusters took.
struct WindowReaches {
  std::array<std::vector<BodyReach>, tolerances::most_window_halvings + 1> by_depth;
  /// By slot: steps per second of the body's cluster when it last went through a window as a whole,
  /// or tried to [1/s]; 0 at the start of a tick.
  std::vector<double> pace;
  /// Starts a tick of a world with this many slots, without reaches.
  void reset(size_t slots);
};

/// A group of many bodies over a part of a tick of the event stepper. Bodies that closed contacts,
/// joints and springs tie together must take their steps together; others need to only while they
/// may meet. So every body gets a reach for the part; bodies that may meet within their reaches
/// form a cluster; and each cluster goes through the part by itself (EventGroup), several in
/// parallel on the threads of the crew. Where a cluster has too many untied bodies, it goes through
/// each half of the part in turn, with new reaches and clusters, and so on recursively: crowded
/// bodies divide their time finely, and a body that flies alone does not.
///
/// A body may move farther than its reach. If it could then have met a body of another cluster,
/// both clusters are merged and go through the part again.
class GroupWindows {
 public:
  /// Whether a group should go through the tick in windows, judged by the ties and contacts at its
  /// start.
  static bool scattered(const BodyGroup& group, const EventContext& context);

  /// `block_of`: by slot, the body's place in the group; is overwritten by that in its cluster.
  /// `reaches`: entries of the group's bodies are written, from index `depth` on, the number of
  /// halvings so far.
  GroupWindows(std::span<RigidBody> bodies, BodyGroup& group, std::span<uint32_t> block_of,
               WindowReaches& reaches, const SmoothForces& forces, const EventContext& context,
               Crew& crew, int depth = 0);

  /// As EventGroup::advance().
  Status advance(const TickPart& part, EventStats& stats);

 private:
  struct Cluster {
    BodyGroup group;
    std::vector<size_t> pairs;  ///< indices of the group's pairs
    bool crowd = false;         ///< too many untied bodies: is halved, unless few steps suffice
    EventStats stats;
    Status status;
    bool done = false;
  };

  Status run_window(const TickPart& part, EventStats& stats);
  void guess_reaches(const TickPart& part);
  void find_clusters();
  /// Whether the gap of a pair is at most a distance [m], at the start of a window.
  bool within(WatchedPair& w, double distance);
  bool may_meet(WatchedPair& w);
  double max_displacement(const WatchedPair& w) const;
  /// Clusters whose bodies and pairs are the same as in the last attempt keep their result.
  void make_clusters();
  void fill(Cluster& cluster) const;
  void run(Cluster& cluster, const TickPart& part);
  /// False where the cluster should be taken through halves of the part.
  bool run_whole(Cluster& cluster, const TickPart& part);
  bool takes_few_steps(const Cluster& cluster, double seconds) const;
  void note_pace(const Cluster& cluster, double seconds);
  void start_again(Cluster& cluster);
  void put_bodies(std::span<const BodyMotion> motions);
  std::vector<BodyMotion> motions() const;
  void foresee_crowds();
  /// By place: how far bodies moved in the window [m].
  std::vector<double> gone_in_window() const;
  /// Whether bodies moved farther than their reaches, and so far that they could have met bodies of
  /// other clusters; if so their reaches are widened. The bodies must be where the window started.
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
  std::vector<Vec3> halves_;              ///< by place: BodyReach::half
  std::vector<double> gone_;              ///< by place: distance moved in all windows so far [m]
  std::vector<uint32_t> joint_place_;     ///< by joint: place of one of its bodies
  std::vector<uint32_t> coupling_place_;  ///< by coupling: place of one of its bodies
  std::vector<std::pair<uint32_t, uint32_t>> ties_;  ///< places
  BodyClusters together_;
  /// At the start and end of the window, by place; `end_` only for clusters that are done.
  std::vector<BodyMotion> start_, end_;
  std::vector<Cluster> clusters_;  ///< in the order of their first bodies
};

}  // namespace tumble
