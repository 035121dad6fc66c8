#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/shared_manifolds.hpp"

namespace tumble {

/// What is known of a pair of bodies from the tick before.
struct PairHistory {
  std::span<const Contact> contacts;  ///< of the pair, sorted by key
  const CachedPair* seen = nullptr;   ///< null where the narrow phase must look
  /// Of shapes of bodies that have several, near each other; sorted.
  std::span<const CachedPair> pieces = {};
};

/// Finds the contacts of single pairs of bodies, with the forces of the points that they continue.
class PairContacts {
 public:
  std::span<const PairSide> sides;  ///< by first proxy of a body
  std::span<const RigidBody> bodies;
  SideTick tick;
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;

  /// Whether all that is known may be carried along (cached_pair.hpp): the bodies hardly moved
  /// against each other since the narrow phase looked. Of bodies of several shapes look() finds
  /// out.
  bool knows(const ProxyPair& pair, const PairHistory& history) const;
  /// Has the narrow phase look: appends what it sees of the pair. True where the contacts may be
  /// carried along all the same, and no manifolds are appended.
  bool look(const ProxyPair& pair, const PairHistory& history, Sights& sights) const;
  /// Makes the contacts of a pair from what was seen of it, sorted by key, with the forces of those
  /// that they continue. There are as many as manifolds.
  void make(const ProxyPair& pair, std::span<const Contact> before,
            std::span<const Manifold> manifolds, std::span<const ShapesOfPair> shapes,
            std::span<Contact> contacts) const;

  ContactKey key(const ProxyPair& pair) const {
    return {sides[pair.a].body, sides[pair.b].body, 0, 0, 0};
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
std::span<const uint64_t> pressed_features(std::span<const Contact> contacts,
                                           std::vector<uint64_t>& memory);

}  // namespace tumble
