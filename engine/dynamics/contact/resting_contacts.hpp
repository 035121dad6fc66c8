#pragma once
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/contact/contact.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The contacts of bodies that rest, by pile: bodies that contacts, or looks that saw none,
/// connect. A tick neither reads nor moves them until one of their bodies is disturbed, when the
/// pile is taken out as a whole. A contact with what is not dynamic belongs to the pile of its
/// dynamic body.
class RestingContacts {
 public:
  /// Puts away what is known of bodies that rest, sorted. Piles that it touches are merged with
  /// it.
  void add(const ContactKnowledge& settled, std::span<const RigidBody> bodies);
  /// Whether a body belongs to a pile.
  bool holds(uint32_t body) const { return body < pile_of_.size() && pile_of_[body] != none; }
  /// Takes the pile of a body out, if it belongs to one, and appends what is known of it; the order
  /// is then lost. Whether there was one.
  bool take(uint32_t body, ContactKnowledge& out);
  /// The same for all piles that know of any of these, sorted, which need not belong to a pile:
  /// what is not dynamic does not. Reads everything that is put away.
  void take_all_of(std::span<const uint32_t> bodies, ContactKnowledge& out);

  /// Another number whenever there is anything else than before.
  uint64_t revision() const { return revision_; }
  bool empty() const { return contacts_ + looks_ == 0; }
  size_t contacts() const { return contacts_; }
  uint64_t points() const { return points_; }
  double max_penetration();  ///< [m]
  /// Calls f(what is known) for every pile.
  template <class F>
  void for_piles(const F& f) const {
    for (const Pile& pile : piles_)
      if (!pile.bodies.empty()) f(pile.known);
  }

  /// From here on all changes can be undone by go_back().
  void begin_tick() { undo_.clear(); }
  void go_back();
  /// Takes all piles out.
  void drop();
  void add_memory(MemoryUse& use) const;

 private:
  static constexpr uint32_t none = ~uint32_t{0};
  struct Pile {
    std::vector<uint32_t> bodies;  ///< dynamic ones; empty: there is no such pile
    ContactKnowledge known;        ///< sorted
    double max_penetration = 0;
  };
  /// A change: the pile at `index` came, or this one was taken from there.
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
  bool max_stale_ = false;    ///< the pile that had it was taken
  std::vector<Change> undo_;  ///< of the tick, oldest first
};

}  // namespace tumble
