#pragma once
#include "engine/dynamics/event/body_group.hpp"

#include <limits>

namespace tumble {

/// A pair of a group of bodies, with what is known of its gap between looks at it.
struct WatchedPair {
  EventPair pair;
  std::vector<EventContact> contacts;
  uint32_t a = no_block, b = no_block;  ///< places in the group of those that move
  /// No less when its bodies had gone as far as `max_displacement` [m].
  double gap = -std::numeric_limits<double>::infinity();
  double max_displacement = 0;  ///< both together [m]
  bool measured = false;        ///< the gap is no more either
  bool meets = false;           ///< in this window

  bool both_move() const { return a != no_block && b != no_block; }
  bool closed() const;
  /// What is left of the gap at least, now that the bodies have gone so far.
  double least_gap(double gone_now) const { return gap - (gone_now - max_displacement); }
  /// Looks at the gap, up to a limit [m].
  void look(std::span<const RigidBody> bodies, const HierarchyKind* hierarchy, double limit,
            double gone_now);
  /// Takes the pair and its contacts as a group that it was part of left them.
  void take(const EventPair& p, std::span<const EventContact> all, double gone_now);
};

/// The pairs of a group with their contacts; `block_of`: by slot the place in the group.
std::vector<WatchedPair> watched_pairs(BodyGroup& group, std::span<const uint32_t> block_of);
/// The group's pairs and contacts as they are now. What met nobody in the last window has no
/// contacts.
void give_back(std::span<const WatchedPair> pairs, std::span<const double> max_displacement,
               BodyGroup& group);

}  // namespace tumble
