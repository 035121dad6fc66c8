#pragma once
#include "engine/dynamics/contact/exact/body_clusters.hpp"
#include "engine/dynamics/contact/exact/event_group.hpp"

namespace tumble {

/// A group of many bodies over a tick of the event stepper. What closed contacts, joints and
/// springs tie together has to move together; other bodies do so only while they may meet. So the
/// tick is cut into windows. At the start of one every body gets a reach for it, bodies that may
/// meet within theirs are a cluster, and every cluster goes through the window by itself, with its
/// own steps and events (EventGroup). Where a body leaves its reach, those that it may meet within
/// a wider one go through the window again, together. Windows are
/// as long as it costs little that bodies move together that nothing ties to each other.
class GroupWindows {
 public:
  /// Whether a group is worth it: clusters at the start of the tick as far as known from its ties
  /// and contacts.
  static bool scattered(const BodyGroup& group, const EventContext& context);

  /// `block_of`: by slot the body's place in the group; will be that in its cluster. `reaches`: by
  /// slot, for the windows; of its bodies they are the group's to write.
  GroupWindows(std::span<RigidBody> bodies, BodyGroup& group, std::span<uint32_t> block_of,
               std::span<BodyReach> reaches, const SmoothForces& forces,
               const EventContext& context);

  /// As EventGroup::advance() over a whole tick of h seconds.
  Status advance(double h, EventStats& stats);

 private:
  /// A pair of the group, with what is known of its gap between looks at it.
  struct Watched {
    EventPair pair;
    std::vector<EventContact> contacts;
    uint32_t a = no_block, b = no_block;  ///< places of those that move
    double gap;                           ///< no less when its bodies had gone as far as `gone` [m]
    double gone = 0;                      ///< both together [m]
    bool measured = false;                ///< no more either
    bool meets = false;                   ///< in this window
  };
  struct Cluster {
    BodyGroup group;
    std::vector<size_t> pairs;  ///< of the group's
    size_t strangers = 0;
    EventStats stats;
    Status status;
    bool done = false;
  };

  void take_pairs();
  double time(uint32_t units) const;
  /// Plans a window from `now` on, in units, after one of `length`; gives how long it is. The first
  /// of a tick is as long as no more than EventContext::most_strangers move together. Then one is
  /// half as long as the last if most steps there were for the sake of strangers, and twice as long
  /// if few were.
  uint32_t next_window(uint32_t now, uint32_t length);
  /// Reaches and clusters for a window from now on. False where more strangers would move together.
  bool plan(uint32_t length, size_t most_strangers);
  bool find_clusters(size_t most_strangers);
  bool may_meet(Watched& w);
  void look(Watched& w, double limit) const;
  double gone(const Watched& w) const;
  /// What went through the window with the same bodies need not do so again.
  void make_clusters();
  void put_bodies(std::span<const BodyMotion> motions);
  std::vector<BodyMotion> motions() const;
  Status run_window(const TickPart& part);
  /// Whether any body needs more than it has.
  bool widen_reaches();
  /// Whether the bodies stay within the group's reach in the window; else the tick is given up.
  bool within_group(double left);
  /// What bodies did in the last window that moved with strangers: their steps and events.
  size_t coupling() const;
  void commit(EventStats& stats);
  void add_books(const Cluster& cluster);
  void give_contacts();

  std::span<RigidBody> bodies_;
  BodyGroup& group_;
  std::span<uint32_t> block_of_;
  std::span<BodyReach> reaches_;
  const SmoothForces& forces_;
  const EventContext& context_;
  double h_ = 0;
  double looks_ahead_ = 1;  ///< a gap is measured as far as so many reaches
  std::vector<Watched> pairs_;
  std::vector<Vec3> halves_;                         ///< by place: BodyReach::half
  std::vector<double> gone_;                         ///< by place, over the windows [m]
  std::vector<uint32_t> joint_place_;                ///< of a body of each joint
  std::vector<size_t> joint_row_;                    ///< the first of each joint
  std::vector<std::pair<uint32_t, uint32_t>> ties_;  ///< places
  BodyClusters together_;
  std::vector<BodyMotion> start_, end_;  ///< of the window, by place; `end_` of what is done
  std::vector<Cluster> clusters_;        ///< by their least body
};

}  // namespace tumble
