#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/shared_manifolds.hpp"

#include <algorithm>

namespace tumble {

/// What is remembered of a pair from the tick before.
struct PairHistory {
  std::span<const Contact> contacts;          ///< of the pair, sorted by key
  const CachedPair* seen = nullptr;           ///< null where the narrow phase must run
  std::span<const CachedShapes> pieces = {};  ///< of the pair, sorted by shapes
};

/// Finds the contacts of single pairs, with the forces of the points that they continue. knows()
/// and look() are for pairs of two single shapes; CompoundPair serves bodies of several.
class PairContacts {
 public:
  std::span<const PairSide> sides;  ///< by proxy
  std::span<const RigidBody> bodies;
  SideTick tick;
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;

  /// Whether the last result of the narrow phase still holds and may be carried along
  /// (cached_pair.hpp), because the bodies hardly moved relative to each other since.
  bool knows(const ProxyPair& pair, const PairHistory& history) const;
  /// Runs the narrow phase and appends what it finds of the pair.
  void look(const ProxyPair& pair, const PairHistory& history, Sights& sights) const;
  /// Makes the contacts of a pair from the manifolds that were found, sorted by key, with the
  /// forces of the contacts that they continue. There are as many as manifolds; `shapes` is empty
  /// for two single shapes.
  void make(const ProxyPair& pair, std::span<const Contact> before,
            std::span<const Manifold> manifolds, std::span<const ShapesOfPair> shapes,
            std::span<Contact> contacts) const;

  ContactKey key(const ProxyPair& pair) const {
    const PairSide &a = sides[pair.a], &b = sides[pair.b];
    return {a.body, a.shape_index, b.body, b.shape_index, 0};
  }

  /// The gap up to which two sides may touch within the tick, by their present velocities and
  /// gravity [m].
  double reach(const PairSide& a, const PairSide& b) const;
  /// Result of the narrow phase on two shapes.
  struct Look {
    /// All gaps up to this were found; where none was, the shapes are farther apart [m]
    double margin;
    bool none;  ///< no manifold was found
  };
  /// Appends the manifolds of two shapes.
  Look look_at_shapes(const PairSide& a, const PairSide& b, ContactQuery query,
                      std::vector<Manifold>& out) const;
};

/// The features of the points that pressed in the last tick; they are stored in `memory`.
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
