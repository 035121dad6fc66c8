#pragma once
#include "engine/dynamics/contact/contact_set.hpp"

namespace tumble {

/// What is known of a pair of shapes from the tick before.
struct PairHistory {
  std::span<const Contact> contacts;  ///< of the pair, sorted by key
  const SeenPair* seen = nullptr;     ///< null where the narrow phase must look
};

/// Finds the contacts of single pairs of shapes, with the forces of the points that they continue.
class PairContacts {
 public:
  std::span<const RigidBody> bodies;
  Vec3 gravity = Vec3::Zero();
  double h = 0;
  double margin = 0;  ///< RealtimeSettings::speculative_margin
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;

  /// Whether the contacts of the history may be carried along (seen_pair.hpp): the bodies hardly
  /// moved against each other since the narrow phase looked.
  bool knows(const ContactKey& pair, const PairHistory& history) const;
  /// Has the narrow phase look: appends the contacts of the pair, and what was seen where that may
  /// be carried along.
  void look(const ContactKey& pair, const PairHistory& history, std::vector<Manifold>& scratch,
            std::vector<Contact>& contacts, std::vector<SeenPair>& seen) const;

 private:
  double reach(const ContactKey& pair) const;
  void find(const ContactKey& pair, double reach, std::span<const Contact> before,
            std::vector<Manifold>& scratch, std::vector<Contact>& contacts) const;
};

}  // namespace tumble
