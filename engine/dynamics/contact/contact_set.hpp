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
  uint64_t pairs = 0;     ///< pairs of shapes, or of whole bodies, whose bounds overlap
  uint64_t carried = 0;   ///< of them, those at which the narrow phase did not have to look again
  uint64_t contacts = 0;  ///< with at least one point
  uint64_t points = 0;
  double max_penetration = 0;  ///< [m]
};

/// What the narrow phase saw of some pairs.
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

/// The contacts of a world, persistent over ticks. Those between bodies none of which seeks
/// contacts (sleeping, fixed) are put away as they are; the others are in one list, sorted by key.
class ContactSet {
 public:
  /// Brings the contacts up to date with the bodies: runs `narrow_phase` on every pair of which it
  /// cannot tell by what it saw before (in parallel inside `crew`, same result for any number of
  /// threads), takes over the forces of matching old points, and drops what is apart by more than
  /// `margin` [m].
  ContactUpdateStats update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                            std::span<const ProxyPair> pairs, const Vec3& gravity, double h,
                            double margin, Crew& crew, NarrowPhase narrow_phase = &collide,
                            const HierarchyKind* hierarchy = nullptr);
  /// Brings back what was put away of the piles to which these bodies belong, after an update.
  /// Whether there was anything.
  bool rouse(std::span<const uint32_t> bodies);
  bool rests(uint32_t body) const { return resting_.holds(body); }

  /// Those that are not put away.
  std::span<const Contact> contacts() const { return now_.contacts; }
  std::span<Contact> contacts() { return now_.contacts; }
  /// Those that are put away, in the order of their keys.
  std::vector<const Contact*> resting() const;
  uint64_t resting_points() const { return resting_.points(); }
  /// Another number whenever others are.
  uint64_t resting_revision() const { return resting_.revision(); }
  /// All, in the order of their keys.
  std::vector<const Contact*> all() const;
  /// Calls f for all, in any order.
  template <class F>
  void for_each(const F& f) const {
    for (const Contact& c : now_.contacts) f(c);
    resting_.for_piles([&f](const ContactKnowledge& pile) {
      for (const Contact& c : pile.contacts) f(c);
    });
  }
  /// Calls f(key) for all pairs that are known, more than once for some.
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

  /// From here on the contacts as they are now are kept until the next call, for go_back.
  void begin_tick();
  /// Undoes every update, assignment and exchange since begin_tick.
  void go_back();

  /// Replaces all by what another stepper kept, sorted by key.
  void assign(std::vector<Contact> contacts);
  /// Takes the contacts of other bodies in or out of those that are not put away, sorted by key;
  /// the rest is as it was.
  void exchange(std::vector<Contact> contacts);

  /// Takes some out of those that are not put away, before updates with pairs that do not name
  /// them, which would drop them.
  ContactKnowledge take_out(const std::function<bool(const ContactKey&)>& which);
  /// Brings back what take_out() gave.
  void put_in(const ContactKnowledge& taken);

  /// After the last of `parts` equal parts of a tick: impulses of a part become those of the tick,
  /// as if all parts had been alike. Contacts at rest were not solved and keep what they had.
  void scale_impulses(int parts, std::span<const RigidBody> bodies);

  /// Drops the contacts of a body that is removed or replaced. Call wake_touching first.
  void remove_body(uint32_t body);
  void clear();

  void add_memory(MemoryUse& use) const;

  /// Everything that a later step reads.
  void save(ByteWriter& out) const;
  /// False when the bytes are cut short or name a body slot >= `body_slots`.
  bool load(ByteReader& in, uint32_t body_slots);

 private:
  /// Where the contacts of a pair come from.
  struct Source {
    ProxyPair pair;
    std::span<const Contact> before;   ///< those of the tick before
    const CachedPair* look = nullptr;  ///< what is still known; null where the narrow phase looked
    bool carried = false;              ///< the contacts are those of before, else made
    uint32_t contacts = 0, looks = 0;  ///< taken from the chunk's manifolds and looks, in order
  };
  /// What one task finds.
  struct Chunk {
    std::vector<Source> sources;
    Sights sights;
    size_t contacts = 0, looks = 0;                             ///< of all sources
    size_t first_contact = 0, first_look = 0, first_piece = 0;  ///< where they go
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
  /// Makes room in now_, which is then whatever it was long ago; what it held is returned.
  const ContactKnowledge& set_aside();

  ContactKnowledge now_;
  ContactKnowledge kept_;  ///< of the beginning of the tick, if it is no longer now_
  bool kept_valid_ = false;
  ContactKnowledge old_;  ///< of the update before
  bool may_rest_ = true;  ///< now_ may hold what is to be put away
  RestingContacts resting_;
  ContactKnowledge settled_, roused_, both_;  ///< scratch
  std::vector<PairSide> sides_;               ///< by proxy; those of the pairs
  std::vector<uint32_t> paired_;              ///< proxies of the pairs, where they are few
  std::vector<Chunk> chunks_;                 ///< kept to reuse the memory
};

}  // namespace tumble
