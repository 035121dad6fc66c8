#pragma once
#include "engine/collision/few_points.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/contact/pair_side.hpp"
#include "engine/dynamics/contact/realtime_settings.hpp"
#include "engine/dynamics/rigid/body.hpp"
#include "engine/dynamics/rigid/proxies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// What a contact is between; the order in which contacts are kept, summed and solved. body_a is
/// the lower slot.
struct ContactKey {
  uint32_t body_a = 0, shape_a = 0;
  uint32_t body_b = 0, shape_b = 0;
  uint64_t part = 0;  ///< Manifold::part

  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// One point of a contact, with what the solver remembers from tick to tick.
struct ContactPoint {
  Vec3 anchor_a = Vec3::Zero();  ///< point of A's surface relative to its centre of mass, body axes
  Vec3 anchor_b = Vec3::Zero();  ///< point of B's surface, likewise
  double gap = 0;                ///< at the start of the tick; negative is penetration [m]
  uint64_t feature = 0;          ///< ManifoldPoint::feature
  double normal_force = 0;       ///< of the last sub-step [N]; warm start
  Vec3 friction_force = Vec3::Zero();    ///< on B, of the last sub-step, world axes [N]; warm start
  double normal_impulse = 0;             ///< sum over the last tick [N s]
  Vec3 friction_impulse = Vec3::Zero();  ///< on B, sum over the last tick, world axes [N s]
};

/// What the points of a contact share.
struct ContactHead {
  ContactKey key;
  Vec3 normal = Vec3::UnitY();    ///< unit, from A to B, world axes
  Vec3 normal_a = Vec3::UnitY();  ///< the same in A's axes, when the narrow phase looked
  double friction = 0;            ///< combined [-]
  double restitution = 0;         ///< combined [-]
  /// Velocity of B's surface relative to A's that belts ask for, world axes [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Radius of a round surface at the contact [m]: it rolls under its anchors, which are moved
  /// along the normal instead of being carried around. 0 for flat faces, edges and corners.
  double rounding_a = 0, rounding_b = 0;
  /// Of the small patch that resists spinning about the normal where bodies touch in one point [m].
  double spin_radius = 0;
  double spin_torque = 0;   ///< on B about the normal, of the last sub-step [N m]; warm start
  double spin_impulse = 0;  ///< on B about the normal, sum over the last part of a tick [N m s]
  ClosestFeatures closest;  ///< Manifold::closest
  int count = 0;            ///< points
};

/// Where two shapes touch or are about to: up to four points that share a normal.
struct Contact : FewPoints<ContactHead, ContactPoint> {
  Contact() {}  // not cleared where it is made by resize
  /// Whether any point pressed during the last tick.
  bool pressed() const {
    return std::ranges::any_of(used(), [](const ContactPoint& p) { return p.normal_impulse > 0; });
  }
};

/// Where two bodies were against each other when the narrow phase last looked at a pair of their
/// shapes. While they hardly move, what it saw is carried along; that nothing was seen, too.
struct SeenPair {
  ContactKey pair;    ///< part is 0
  Pose relative;      ///< of the smaller body's frame in the larger one's
  double margin = 0;  ///< all gaps up to here were found; where none was, there is none [m]
};

/// Midway between the surfaces at point i, world axes [m].
Vec3 contact_position(const Contact& contact, int i, std::span<const RigidBody> bodies);
/// Impulse on B at point i over the last tick, world axes [N s].
Vec3 contact_impulse(const Contact& contact, int i);

/// Properties of a contact of two materials.
struct CombinedMaterial {
  double friction = 0;
  double restitution = 0;
};
/// Friction sqrt(mu_A mu_B), restitution the larger. Of two materials, or what carries their
/// coefficients.
template <class Side>
CombinedMaterial combine(const Side& a, const Side& b) {
  return {std::sqrt(a.friction * b.friction), std::max(a.restitution, b.restitution)};
}

struct ContactUpdateStats {
  uint64_t pairs = 0;     ///< pairs of shapes whose bounds overlap
  uint64_t carried = 0;   ///< of them, those at which the narrow phase did not have to look again
  uint64_t contacts = 0;  ///< with at least one point
  uint64_t points = 0;
  double max_penetration = 0;  ///< [m]
};

/// What the narrow phase saw of some pairs.
struct Sights {
  std::vector<Manifold> manifolds;
  std::vector<SeenPair> seen;  ///< of pairs whose contacts may be carried along, or that are apart
};

class PairContacts;

/// The contacts of a world, sorted by key, persistent over ticks.
class ContactSet {
 public:
  /// Brings the contacts up to date with the bodies: runs `narrow_phase` on every pair of which it
  /// cannot tell by what it saw before (in parallel inside `crew`, same result for any number of
  /// threads), takes over the forces of matching old points, and drops what is apart. Contacts
  /// between bodies none of which seeks contacts (sleeping, fixed) are kept as they are.
  ContactUpdateStats update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                            std::span<const ProxyPair> pairs, const Vec3& gravity, double h,
                            const RealtimeSettings& settings, Crew& crew,
                            NarrowPhase narrow_phase = &collide,
                            const HierarchyKind* hierarchy = nullptr);

  std::span<const Contact> contacts() const { return now_.contacts; }
  std::span<Contact> contacts() { return now_.contacts; }
  size_t size() const { return now_.contacts.size(); }

  /// From here on the contacts as they are now are kept until the next call, for go_back.
  void begin_tick() { kept_valid_ = false; }
  /// Undoes every update, assignment and exchange since begin_tick.
  void go_back();

  /// Replaces all by what another stepper kept, sorted by key.
  void assign(std::vector<Contact> contacts);
  /// Takes the contacts of other bodies in or out, sorted by key; the rest is as it was.
  void exchange(std::vector<Contact> contacts);

  /// After the last of `parts` equal parts of a tick: impulses of a part become those of the tick,
  /// as if all parts had been alike. Contacts at rest were not solved and keep what they had.
  void scale_impulses(int parts, std::span<const RigidBody> bodies);

  /// Drops the contacts of a body that is removed or replaced. Call wake_touching first.
  void remove_body(uint32_t body);
  void clear() { assign({}); }

  void add_memory(MemoryUse& use) const;

  /// Everything that a later step reads.
  void save(ByteWriter& out) const;
  /// False when the bytes are cut short or name a body slot >= `body_slots`.
  bool load(ByteReader& in, uint32_t body_slots);

 private:
  struct Knowledge {
    std::vector<Contact> contacts;
    std::vector<SeenPair> seen;  ///< sorted by pair
  };
  /// Where the contacts of a pair come from.
  struct Source {
    ProxyPair pair;
    std::span<const Contact> before;  ///< those of the tick before
    const SeenPair* look = nullptr;   ///< null where the narrow phase looked: else they are carried
    uint32_t contacts = 0, looks = 0;  ///< taken from the chunk's manifolds and looks, in order
  };
  /// What one task finds.
  struct Chunk {
    std::vector<Source> sources;
    Sights sights;
    size_t contacts = 0, looks = 0;            ///< of all sources
    size_t first_contact = 0, first_look = 0;  ///< where they go
    ContactUpdateStats stats;
  };
  static void find_chunk(const Knowledge& old, std::span<const ProxyPair> pairs,
                         const PairContacts& finder, Chunk& out);
  void join(Chunk& chunk, const PairContacts& finder);
  void keep_resting(const Knowledge& old, std::span<const RigidBody> bodies);
  /// Makes room in now_, which is then whatever it was long ago; what it held is returned.
  const Knowledge& set_aside();

  Knowledge now_;
  Knowledge kept_;  ///< of the beginning of the tick, if it is no longer now_
  bool kept_valid_ = false;
  Knowledge old_;                ///< of the update before
  std::vector<PairSide> sides_;  ///< by proxy
  std::vector<Chunk> chunks_;    ///< kept to reuse the memory
};

}  // namespace tumble
