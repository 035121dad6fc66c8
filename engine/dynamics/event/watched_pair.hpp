#pragma once
#include "engine/dynamics/event/body_group.hpp"

#include <limits>

namespace tumble {

/// A pair of a group of bodies, with what is known of its gap since it was last computed.
struct WatchedPair {
  EventPair pair;
  std::vector<EventContact> contacts;
  /// Places in the group; no_block for a body that does not move.
  uint32_t a = no_block, b = no_block;
  /// Lower bound of the gap when the bodies had moved by `max_displacement` in all [m].
  double gap = -std::numeric_limits<double>::infinity();
  double max_displacement = 0;  ///< sum for both bodies [m]
  bool measured = false;        ///< `gap` is the exact value, not only a bound
  bool meets = false;           ///< may meet in this window

  bool both_move() const { return a != no_block && b != no_block; }
  bool closed() const;
  /// Lower bound of the gap now that the bodies have moved by `gone_now` in all [m].
  double least_gap(double gone_now) const { return gap - (gone_now - max_displacement); }
  /// Computes the gap, up to a limit [m].
  void look(std::span<const RigidBody> bodies, const HierarchyKind* hierarchy, double limit,
            double gone_now);
  /// Takes over the pair and its contacts from a cluster that it was part of.
  void take(const EventPair& p, std::span<const EventContact> all, double gone_now);
};

/// The pairs of a group with their contacts; `block_of`: by slot the place in the group.
std::vector<WatchedPair> watched_pairs(BodyGroup& group, std::span<const uint32_t> block_of);
/// Writes pairs and contacts back to the group. Pairs that could not meet in the last window have
/// no contacts.
void give_back(std::span<const WatchedPair> pairs, std::span<const double> max_displacement,
               BodyGroup& group);

}  // namespace tumble
