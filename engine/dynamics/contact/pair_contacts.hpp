#pragma once
#include "engine/dynamics/contact/contact_set.hpp"

namespace tumble {

/// What is known of a pair of shapes from the tick before.
struct PairHistory {
  std::span<const Contact> contacts;  ///< of the pair, sorted by key
  const CachedPair* seen = nullptr;   ///< null where the narrow phase must look
};

/// Finds the contacts of single pairs of shapes, with the forces of the points that they continue.
class PairContacts {
 public:
  std::span<const PairSide> sides;  ///< by proxy
  double h = 0;
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;

  /// Whether the contacts of the history may be carried along (cached_pair.hpp): the shapes hardly
  /// moved against each other since the narrow phase looked.
  bool knows(const ProxyPair& pair, const PairHistory& history) const;
  /// Has the narrow phase look: appends what it sees of the pair.
  void look(const ProxyPair& pair, const PairHistory& history, Sights& sights) const;
  /// Makes the contacts of a pair from what was seen of it, sorted by key, with the forces of those
  /// that they continue. There are as many as manifolds.
  void make(const ProxyPair& pair, std::span<const Contact> before,
            std::span<const Manifold> manifolds, std::span<Contact> contacts) const;

  ContactKey key(const ProxyPair& pair) const {
    const PairSide &a = sides[pair.a], &b = sides[pair.b];
    return {a.body, a.shape_index, b.body, b.shape_index, 0};
  }

 private:
  double reach(const PairSide& a, const PairSide& b) const;
};

}  // namespace tumble
