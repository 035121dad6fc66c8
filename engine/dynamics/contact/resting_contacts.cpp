#include "engine/dynamics/contact/resting_contacts.hpp"

#include "engine/core/disjoint_sets.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

double deepest(std::span<const Contact> contacts) {
  double depth = 0;
  for (const Contact& c : contacts)
    for (const ContactPoint& p : c.used()) depth = std::max(depth, -p.gap);
  return depth;
}

uint64_t points_of(std::span<const Contact> contacts) {
  uint64_t count = 0;
  for (const Contact& c : contacts) count += uint64_t(c.count);
  return count;
}

/// Index of a body in a sorted list.
uint32_t place_of(std::span<const uint32_t> sorted, uint32_t body) {
  return uint32_t(std::ranges::lower_bound(sorted, body) - sorted.begin());
}

/// Calls f(body) for the dynamic bodies of a pair.
template <class F>
void for_dynamic(const ContactKey& key, std::span<const RigidBody> bodies, const F& f) {
  for (const uint32_t body : {key.body_a, key.body_b})
    if (bodies[body].dynamic()) f(body);
}

}  // namespace

uint32_t RestingContacts::free_index() {
  if (free_.empty()) {
    piles_.emplace_back();
    return uint32_t(piles_.size() - 1);
  }
  const uint32_t index = free_.back();
  free_.pop_back();
  return index;
}

void RestingContacts::insert(Pile&& pile, uint32_t index) {
  ++revision_;
  const uint32_t last = std::ranges::max(pile.bodies);
  if (pile_of_.size() <= last) pile_of_.resize(last + 1, none);
  for (const uint32_t body : pile.bodies) pile_of_[body] = index;
  contacts_ += pile.known.contacts.size();
  looks_ += pile.known.seen.size();
  points_ += points_of(pile.known.contacts);
  max_penetration_ = std::max(max_penetration_, pile.max_penetration);
  piles_[index] = std::move(pile);
}

RestingContacts::Pile RestingContacts::remove(uint32_t index) {
  ++revision_;
  Pile pile = std::exchange(piles_[index], {});
  for (const uint32_t body : pile.bodies) pile_of_[body] = none;
  contacts_ -= pile.known.contacts.size();
  looks_ -= pile.known.seen.size();
  points_ -= points_of(pile.known.contacts);
  max_stale_ |= pile.max_penetration >= max_penetration_;
  return pile;
}

double RestingContacts::max_penetration() {
  if (std::exchange(max_stale_, false)) {
    max_penetration_ = 0;
    for (const Pile& p : piles_) max_penetration_ = std::max(max_penetration_, p.max_penetration);
  }
  return max_penetration_;
}

void RestingContacts::take_pile(uint32_t index, ContactKnowledge& out) {
  undo_.push_back({index, remove(index)});
  free_.push_back(index);
  out.append(undo_.back().taken.known);
}

bool RestingContacts::take(uint32_t body, ContactKnowledge& out) {
  if (!holds(body)) return false;
  take_pile(pile_of_[body], out);
  return true;
}

void RestingContacts::take_all_of(std::span<const uint32_t> bodies, ContactKnowledge& out) {
  const auto names = [bodies](const ContactKey& key) {
    return std::ranges::binary_search(bodies, key.body_a) ||
           std::ranges::binary_search(bodies, key.body_b);
  };
  for (uint32_t index = 0; index < piles_.size(); ++index) {
    const ContactKnowledge& known = piles_[index].known;
    if (std::ranges::any_of(known.contacts, names, &Contact::key) ||
        std::ranges::any_of(known.seen, names, &CachedPair::pair))
      take_pile(index, out);
  }
}

void RestingContacts::drop() {
  for (uint32_t index = 0; index < piles_.size(); ++index) {
    if (piles_[index].bodies.empty()) continue;
    undo_.push_back({index, remove(index)});
    free_.push_back(index);
  }
}

/// Divides contents that are sorted and connect to no existing pile into piles.
void RestingContacts::group(const ContactKnowledge& known, std::span<const RigidBody> bodies) {
  std::vector<uint32_t> members;
  const auto each_key = [&known](const auto& f) {
    for (const Contact& c : known.contacts) f(c.key);
    for (const CachedPair& s : known.seen) f(s.pair);
  };
  each_key([&](const ContactKey& key) {
    for_dynamic(key, bodies, [&](uint32_t body) { members.push_back(body); });
  });
  std::ranges::sort(members);
  members.erase(std::unique(members.begin(), members.end()), members.end());
  DisjointSets sets(members.size());
  // Index of a dynamic body of the pair among the members.
  const auto place = [&](const ContactKey& key) {
    return place_of(members, bodies[key.body_a].dynamic() ? key.body_a : key.body_b);
  };
  each_key([&](const ContactKey& key) {
    if (bodies[key.body_a].dynamic() && bodies[key.body_b].dynamic())
      sets.join(place_of(members, key.body_a), place_of(members, key.body_b));
  });
  std::vector<Pile> piles;
  std::vector<uint32_t> pile_of(members.size());
  for (uint32_t k = 0; k < members.size(); ++k) {
    const uint32_t root = sets.root(k);  // root <= k
    if (root == k) piles.emplace_back();
    pile_of[k] = root == k ? uint32_t(piles.size() - 1) : pile_of[root];
    piles[pile_of[k]].bodies.push_back(members[k]);
  }
  for (const Contact& c : known.contacts) piles[pile_of[place(c.key)]].known.contacts.push_back(c);
  for (const CachedPair& s : known.seen) piles[pile_of[place(s.pair)]].known.seen.push_back(s);
  for (const CachedShapes& s : known.pieces)
    piles[pile_of[place(s.pair)]].known.pieces.push_back(s);
  for (Pile& pile : piles) {
    pile.known.contacts.shrink_to_fit();
    pile.max_penetration = deepest(pile.known.contacts);
    const uint32_t index = free_index();
    insert(std::move(pile), index);
    undo_.push_back({index, {}});
  }
}

void RestingContacts::add(const ContactKnowledge& settled, std::span<const RigidBody> bodies) {
  ContactKnowledge merged;
  const auto take_piles = [&](const ContactKey& key) {
    for_dynamic(key, bodies, [&](uint32_t body) { take(body, merged); });
  };
  for (const Contact& c : settled.contacts) take_piles(c.key);
  for (const CachedPair& s : settled.seen) take_piles(s.pair);
  if (merged.empty()) return group(settled, bodies);
  merged.append(settled);
  merged.sort();
  group(merged, bodies);
}

void RestingContacts::go_back() {
  for (auto at = undo_.rbegin(); at != undo_.rend(); ++at) {
    Change& change = *at;
    if (change.taken.bodies.empty()) {
      remove(change.index);
      free_.push_back(change.index);
    } else {
      std::erase(free_, change.index);
      insert(std::move(change.taken), change.index);
    }
  }
  undo_.clear();
}

void RestingContacts::add_memory(MemoryUse& use) const {
  use.bodies += heap_bytes(pile_of_);
  use.contacts += heap_bytes(piles_, free_, undo_);
  for (const Pile& p : piles_)
    use.contacts += heap_bytes(p.bodies, p.known.contacts, p.known.seen, p.known.pieces);
}

}  // namespace tumble
