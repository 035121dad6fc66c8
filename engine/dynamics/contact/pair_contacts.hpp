#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/shared_manifolds.hpp"

#include <algorithm>

namespace tumble {

/// What is known of a pair from the tick before.
struct PairHistory {
  std::span<const Contact> contacts;          ///< of the pair, sorted by key
  const CachedPair* seen = nullptr;           ///< null where the narrow phase must look
  std::span<const CachedShapes> pieces = {};  ///< of the pair, sorted by shapes
};

/// Finds the contacts of single pairs, with the forces of the points that they continue. What it
/// says of knows() and look() is for two shapes; of others, CompoundPair.
class PairContacts {
 public:
  std::span<const PairSide> sides;  ///< by proxy
  std::span<const RigidBody> bodies;
  SideTick tick;
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;

  /// Whether all that is known may be carried along (cached_pair.hpp): the bodies hardly moved
  /// against each other since the narrow phase looked.
  bool knows(const ProxyPair& pair, const PairHistory& history) const;
  /// Has the narrow phase look: appends what it sees of the pair.
  void look(const ProxyPair& pair, const PairHistory& history, Sights& sights) const;
  /// Makes the contacts of a pair from what was seen of it, sorted by key, with the forces of those
  /// that they continue. There are as many as manifolds; of two shapes `shapes` is empty.
  void make(const ProxyPair& pair, std::span<const Contact> before,
            std::span<const Manifold> manifolds, std::span<const ShapesOfPair> shapes,
            std::span<Contact> contacts) const;

  ContactKey key(const ProxyPair& pair) const {
    const PairSide &a = sides[pair.a], &b = sides[pair.b];
    return {a.body, a.shape_index, b.body, b.shape_index, 0};
  }

  /// How far apart what touches within the tick may be [m].
  double reach(const PairSide& a, const PairSide& b) const;
  /// What was asked of two shapes.
  struct Look {
    double margin;  ///< all gaps up to here were found, or there is none [m]
    bool none;      ///< nothing was found
  };
  /// Appends the manifolds of two shapes, as they are asked for.
  Look look_at_shapes(const PairSide& a, const PairSide& b, ContactQuery query,
                      std::vector<Manifold>& out) const;
};

/// The features of the points that press, in `memory`.
inline std::span<const uint64_t> pressed_features(std::span<const Contact> contacts,
                                                  std::vector<uint64_t>& memory) {
  memory.resize(std::max(memory.size(), 4 * contacts.size()));
  size_t count = 0;
  for (const Contact& c : contacts) {
    for (const ContactPoint& p : c.used()) {
      memory[count] = p.feature;
      count += p.normal_force > 0;
    }
  }
  return std::span(memory).first(count);
}

}  // namespace tumble
