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
  /// Whether contacts may be carried along while two bodies hardly move against each other.
  bool carry = true;

  /// Appends the contacts of the pair, and what was seen where that may be carried along. Whether
  /// it was: then the narrow phase did not look.
  bool find(const ContactKey& pair, const PairHistory& history, std::vector<Manifold>& scratch,
            std::vector<Contact>& contacts, std::vector<SeenPair>& seen) const;

 private:
  void look(const ContactKey& pair, double reach, std::span<const Contact> before,
            std::vector<Manifold>& scratch, std::vector<Contact>& contacts) const;
};

}  // namespace tumble
