#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/way.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// How bodies that have met in a tick go on for the rest of it: what they do to each other is left
/// to the solver in the next tick, so that nothing but their places is at stake until then. What
/// cannot give way, or has more mass than the whole island of the other, goes its way and takes
/// the other along: a kinematic body, or a heavy one that meets light ones. Where neither has, both
/// stay where they are.
class JoinedWays {
 public:
  /// Over h seconds; by slot, nobody has met yet.
  JoinedWays(std::span<const RigidBody> bodies, std::span<const Track> tracks,
             const IslandSet& islands, double h)
      : bodies_(bodies), tracks_(tracks), islands_(&islands), place_(bodies.size(), none), h_(h) {}

  Way way(uint32_t body) const {
    const Motion& own = tracks_[body].motion;
    return place_[body] == none ? Way(own) : Way(own, met_[place_[body]].legs);
  }
  /// Another with every leg that begins; 0 as long as there is one only.
  uint32_t version(uint32_t body) const {
    return place_[body] == none ? 0 : met_[place_[body]].version;
  }
  bool together(uint32_t a, uint32_t b) const {
    return place_[a] != none && place_[b] != none && met_[place_[a]].group == met_[place_[b]].group;
  }
  /// a and b meet at time t, no earlier than any before. Where neither takes the other along, those
  /// stop that are said to. Gives the bodies that go another way from then on.
  std::vector<uint32_t> meet(uint32_t a, uint32_t b, double t, bool stops_a, bool stops_b);

 private:
  static constexpr uint32_t none = ~uint32_t{0};
  struct Group {
    uint32_t leader = 0;
    std::vector<uint32_t> members;
  };
  struct Met {
    uint32_t group = 0;
    uint32_t version = 0;
    std::vector<Motion> legs;  ///< after the first
  };
  bool gives_way(uint32_t body) const { return bodies_[body].dynamic() && bodies_[body].awake(); }
  Met& met(uint32_t body) { return met_[place_[body]]; }
  Group& group(uint32_t body) { return groups_[met(body).group]; }
  void enter(uint32_t body);
  double island_mass(uint32_t body, uint32_t without) const;
  bool takes_along(uint32_t a, uint32_t b);
  void go_on(uint32_t body, const Motion& with, double t);
  std::vector<uint32_t> join(uint32_t body, uint32_t other, double t);
  std::vector<uint32_t> squeeze(uint32_t a, uint32_t b, double t);
  void rest(uint32_t body, bool stops, double t, std::vector<uint32_t>& stopped);

  std::span<const RigidBody> bodies_;
  std::span<const Track> tracks_;
  const IslandSet* islands_;
  std::vector<uint32_t> place_;  ///< by slot, in the following
  std::vector<Met> met_;
  std::vector<Group> groups_;
  double h_;
  uint32_t versions_ = 0;
};

}  // namespace tumble
