#pragma once
#include "engine/collision/narrow_phase.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/contact/pair_side.hpp"
#include "engine/dynamics/contact/resting_contacts.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

struct ContactUpdateStats {
  uint64_t pairs = 0;  ///< pairs of shapes, or of whole bodies, whose bounds overlap
  /// Of these, those whose contacts were carried along without the narrow phase.
  uint64_t carried = 0;
  uint64_t contacts = 0;  ///< with at least one point
  uint64_t points = 0;
  double max_penetration = 0;  ///< deepest overlap of all points [m]
};

/// What the narrow phase found of some pairs.
struct Sights {
  std::vector<Manifold> manifolds;
  std::vector<ShapesOfPair> shapes;  ///< by manifold, where a body of the pair has several shapes
  std::vector<CachedPair>
      seen;  ///< of pairs whose contacts may be carried along, or that are apart
  std::vector<CachedShapes> pieces;

  void clear() {
    manifolds.clear();
    shapes.clear();
    seen.clear();
    pieces.clear();
  }
};

class PairContacts;

/// The contacts of a world, persistent over ticks. Contacts between bodies that are all at rest
/// (sleeping or fixed) are stored away by pile (RestingContacts); the others are in one list,
/// sorted by key.
class ContactSet {
 public:
  /// Brings the contacts up to date with the bodies. Runs `narrow_phase` on each pair whose last
  /// result does not hold any more (in parallel on `crew`, with the same result for any number of
  /// threads), takes over the forces of matching old points, and drops contacts that are too far
  /// apart to touch within the tick. `h` is the length of the tick [s], `margin`
  /// RealtimeSettings::speculative_margin [m].
  ContactUpdateStats update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                            std::span<const ProxyPair> pairs, const Vec3& gravity, double h,
                            double margin, Crew& crew, NarrowPhase narrow_phase = &collide,
                            const HierarchyKind* hierarchy = nullptr);
  /// Takes the contacts of the piles to which these bodies belong back into the list, after an
  /// update. Returns whether there were any.
  bool rouse(std::span<const uint32_t> bodies);
  bool rests(uint32_t body) const { return resting_.holds(body); }

  /// The contacts that are not stored away, sorted by key.
  std::span<const Contact> contacts() const { return now_.contacts; }
  std::span<Contact> contacts() { return now_.contacts; }
  /// The contacts that are stored away, in the order of their keys.
  std::vector<const Contact*> resting() const;
  uint64_t resting_points() const { return resting_.points(); }
  /// Changes whenever the contacts that are stored away do.
  uint64_t resting_revision() const { return resting_.revision(); }
  /// All contacts, in the order of their keys.
  std::vector<const Contact*> all() const;
  /// Calls f for all contacts, in any order.
  template <class F>
  void for_each(const F& f) const {
    for (const Contact& c : now_.contacts) f(c);
    resting_.for_piles([&f](const ContactKnowledge& pile) {
      for (const Contact& c : pile.contacts) f(c);
    });
  }
  /// Calls f(key) for every pair of which anything is known, for some more than once.
  template <class F>
  void for_each_pair(const F& f) const {
    const auto each = [&f](const ContactKnowledge& known) {
      for (const Contact& c : known.contacts) f(c.key);
      for (const CachedPair& s : known.seen) f(s.pair);
    };
    each(now_);
    resting_.for_piles(each);
  }
  size_t size() const { return now_.contacts.size() + resting_.contacts(); }

  /// Keeps the present contacts until the next call, for go_back().
  void begin_tick();
  /// Undoes every update, assignment and exchange since begin_tick.
  void go_back();

  /// Replaces all contacts by those of another stepper, sorted by key; forgets what is known of
  /// pairs.
  void assign(std::vector<Contact> contacts);
  /// Replaces the contacts that are not stored away, sorted by key; what is known of pairs and all
  /// contacts at rest stay.
  void exchange(std::vector<Contact> contacts);

  /// Removes and returns some of the contacts that are not stored away, so that they survive
  /// updates whose pairs do not include theirs.
  ContactKnowledge take_out(const std::function<bool(const ContactKey&)>& which);
  /// Puts back what take_out() returned.
  void put_in(const ContactKnowledge& taken);

  /// To be called after the last of `parts` equal parts of a tick: scales the impulses of that part
  /// to the whole tick, as if all parts had been alike. Contacts at rest were not solved and keep
  /// theirs.
  void scale_impulses(int parts, std::span<const RigidBody> bodies);

  /// Drops the contacts of a body that is removed or replaced. Call wake_touching first.
  void remove_body(uint32_t body);
  void clear();

  void add_memory(MemoryUse& use) const;

  /// Writes everything that a later step reads.
  void save(ByteWriter& out) const;
  /// False when the bytes are cut short or name a body slot >= `body_slots`.
  bool load(ByteReader& in, uint32_t body_slots);

 private:
  /// A pair with contacts or something known of it, and where its contacts come from.
  struct Source {
    ProxyPair pair;
    std::span<const Contact> before;  ///< contacts of the pair in the tick before
    /// What is remembered of the pair; null where the narrow phase ran.
    const CachedPair* look = nullptr;
    /// The contacts are those of `before`, moved with the bodies; otherwise made of manifolds.
    bool carried = false;
    uint32_t contacts = 0, looks = 0;  ///< number of contacts and of records in `seen` of this pair
  };
  /// A range of pairs that one task works on, and what it finds.
  struct Chunk {
    std::vector<Source> sources;
    Sights sights;
    size_t contacts = 0, looks = 0;                             ///< sums over all sources
    size_t first_contact = 0, first_look = 0, first_piece = 0;  ///< where they begin in now_
    ContactUpdateStats stats;
  };
  static void find_chunk(const ContactKnowledge& old, std::span<const ProxyPair> pairs,
                         const PairContacts& finder, Chunk& out);
  void join(Chunk& chunk, const PairContacts& finder);
  void take_sides(std::span<const RigidBody> bodies, const ProxySet& proxies,
                  std::span<const ProxyPair> pairs, const Vec3& gravity, double h, double margin,
                  Crew& crew);
  void put_away(const ContactKnowledge& old, std::span<const RigidBody> bodies);
  bool rouse_active(std::span<const RigidBody> bodies, const ProxySet& proxies);
  void append_resting(std::span<const RigidBody> bodies);
  bool merge_roused();
  /// Returns the present contacts; now_ becomes free to be overwritten and holds stale memory.
  const ContactKnowledge& set_aside();

  ContactKnowledge now_;
  ContactKnowledge kept_;  ///< contacts at the beginning of the tick, if they are no longer in now_
  bool kept_valid_ = false;
  ContactKnowledge old_;  ///< contacts before the last update, if they are not in kept_
  /// now_ may hold contacts between bodies at rest, which are to be stored away.
  bool may_rest_ = true;
  RestingContacts resting_;
  ContactKnowledge settled_, roused_, both_;  ///< scratch
  std::vector<PairSide> sides_;   ///< by proxy; only those that occur in pairs are up to date
  std::vector<uint32_t> paired_;  ///< the proxies that occur in pairs, where they are few
  std::vector<Chunk> chunks_;     ///< kept to reuse the memory
};

}  // namespace tumble
