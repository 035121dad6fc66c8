#pragma once
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/contact/contact.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The contacts of bodies at rest, by pile: a set of dynamic bodies at rest that are connected by
/// contacts, or by pairs that are known to be apart. A tick neither reads nor moves them until one
/// of their bodies is disturbed; then the pile is taken out as a whole. A contact with a fixed or
/// kinematic body belongs to the pile of its dynamic body.
class RestingContacts {
 public:
  /// Adds what is known of bodies at rest, sorted. Piles to which it connects are merged with it.
  void add(const ContactKnowledge& settled, std::span<const RigidBody> bodies);
  /// Whether a body belongs to a pile.
  bool holds(uint32_t body) const { return body < pile_of_.size() && pile_of_[body] != none; }
  /// Removes the pile of a body, if there is one, and appends its contents to `out`, unsorted.
  /// Returns whether there was one.
  bool take(uint32_t body, ContactKnowledge& out);
  /// The same for all piles that have a contact or a known pair with any of these bodies (sorted),
  /// which may be fixed or kinematic bodies and thus belong to no pile. Reads all piles.
  void take_all_of(std::span<const uint32_t> bodies, ContactKnowledge& out);

  /// Changes whenever the contents do.
  uint64_t revision() const { return revision_; }
  bool empty() const { return contacts_ + looks_ == 0; }
  size_t contacts() const { return contacts_; }
  uint64_t points() const { return points_; }
  double max_penetration();  ///< deepest overlap of all points [m]
  /// Calls f(what is known) for every pile.
  template <class F>
  void for_piles(const F& f) const {
    for (const Pile& pile : piles_)
      if (!pile.bodies.empty()) f(pile.known);
  }

  /// From here on all changes can be undone by go_back().
  void begin_tick() { undo_.clear(); }
  void go_back();
  /// Removes all piles.
  void drop();
  void add_memory(MemoryUse& use) const;

 private:
  static constexpr uint32_t none = ~uint32_t{0};
  struct Pile {
    std::vector<uint32_t> bodies;  ///< dynamic ones; empty if the place is not in use
    ContactKnowledge known;        ///< sorted
    double max_penetration = 0;
  };
  /// A change that can be undone: the pile at `index` was added (`taken` is empty), or `taken` was
  /// removed from there.
  struct Change {
    uint32_t index;
    Pile taken;
  };
  void insert(Pile&& pile, uint32_t index);
  Pile remove(uint32_t index);
  void take_pile(uint32_t index, ContactKnowledge& out);
  uint32_t free_index();
  void group(const ContactKnowledge& known, std::span<const RigidBody> bodies);

  std::vector<Pile> piles_;
  std::vector<uint32_t> free_;     ///< indices without a pile
  std::vector<uint32_t> pile_of_;  ///< by body slot
  uint64_t revision_ = 0;
  size_t contacts_ = 0, looks_ = 0;
  uint64_t points_ = 0;
  double max_penetration_ = 0;
  bool max_stale_ = false;    ///< the pile with the deepest overlap was removed
  std::vector<Change> undo_;  ///< changes since begin_tick(), oldest first
};

}  // namespace tumble
