#include "engine/dynamics/contact/contact_set.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/compound_pair.hpp"
#include "engine/dynamics/contact/pair_contacts.hpp"
#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace tumble {

uint64_t mark_of(const ShapesOfPair& shapes) {
  return mix_key(mix_key(0, shapes.a), shapes.b);
}

Vec3 contact_position(const Contact& contact, int i, std::span<const RigidBody> bodies) {
  const ContactPoint& p = contact.points[size_t(i)];
  return 0.5 * (bodies[contact.key.body_a].pose.point(p.anchor_a) +
                bodies[contact.key.body_b].pose.point(p.anchor_b));
}

Vec3 contact_impulse(const Contact& contact, int i) {
  const ContactPoint& p = contact.points[size_t(i)];
  return p.normal_impulse * contact.normal + p.friction_impulse;
}

namespace {

bool key_less(const Contact& a, const Contact& b) {
  return a.key < b.key;
}

bool pair_less(const CachedPair& a, const CachedPair& b) {
  return a.pair < b.pair;
}

}  // namespace

void ContactKnowledge::append(const ContactKnowledge& other) {
  contacts.insert(contacts.end(), other.contacts.begin(), other.contacts.end());
  seen.insert(seen.end(), other.seen.begin(), other.seen.end());
  pieces.insert(pieces.end(), other.pieces.begin(), other.pieces.end());
}

void ContactKnowledge::sort() {
  std::sort(contacts.begin(), contacts.end(), key_less);
  std::sort(seen.begin(), seen.end(), pair_less);
  std::sort(pieces.begin(), pieces.end());
}

namespace {

const ContactKey& key_of(const Contact* c) {
  return c->key;
}

/// Merges two lists, each sorted, into one.
void merge(const ContactKnowledge& a, const ContactKnowledge& b, ContactKnowledge& out) {
  out.clear();
  std::ranges::merge(a.contacts, b.contacts, std::back_inserter(out.contacts), key_less);
  std::ranges::merge(a.seen, b.seen, std::back_inserter(out.seen), pair_less);
  std::ranges::merge(a.pieces, b.pieces, std::back_inserter(out.pieces), std::less());
}

/// Pairs per task: few, so that expensive pairs are shared among threads; but more where there are
/// many, since each task has to find its place among the contacts of the tick before.
size_t pairs_per_chunk(size_t pairs) {
  return std::clamp(pairs / 48, size_t{16}, size_t{64});
}

bool same_pair(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

/// Walks through what was known in the tick before in step with the pairs, which come in the same
/// order.
class HistoryCursor {
 public:
  HistoryCursor(const ContactKnowledge& known, const ContactKey& first)
      : contacts_(known.contacts),
        seen_(known.seen),
        pieces_(known.pieces),
        contact_(std::ranges::lower_bound(contacts_, first, {}, &Contact::key)),
        look_(std::ranges::lower_bound(seen_, first, {}, &CachedPair::pair)),
        piece_(std::ranges::lower_bound(pieces_, first, {}, &CachedShapes::pair)) {}

  PairHistory at(const ContactKey& pair) {
    while (contact_ != contacts_.end() && contact_->key < pair) ++contact_;
    const auto begin = contact_;
    while (contact_ != contacts_.end() && same_pair(contact_->key, pair)) ++contact_;
    while (look_ != seen_.end() && look_->pair < pair) ++look_;
    const bool known = look_ != seen_.end() && same_pair(look_->pair, pair);
    return {{begin, contact_}, known ? &*look_ : nullptr};
  }
  /// What is known of the pairs of shapes of a pair; to be called for pairs in ascending order.
  std::span<const CachedShapes> pieces_of(const ContactKey& pair) {
    while (piece_ != pieces_.end() && piece_->pair < pair) ++piece_;
    const auto begin = piece_;
    while (piece_ != pieces_.end() && same_pair(piece_->pair, pair)) ++piece_;
    return {begin, piece_};
  }

 private:
  std::span<const Contact> contacts_;
  std::span<const CachedPair> seen_;
  std::span<const CachedShapes> pieces_;
  std::span<const Contact>::iterator contact_;
  std::span<const CachedPair>::iterator look_;
  std::span<const CachedShapes>::iterator piece_;
};

/// Whether any dynamic body is at rest (not active).
bool any_rests(std::span<const RigidBody> bodies, Crew& crew) {
  std::array<bool, chunk_count> rests{};
  for_chunks(&crew, bodies.size(), [&](size_t chunk, size_t first, size_t last) {
    rests[chunk] = std::ranges::any_of(bodies.subspan(first, last - first), [](const RigidBody& b) {
      return b.dynamic() && !is_active(b);
    });
  });
  return std::ranges::any_of(rests, std::identity());
}

void count_points(std::span<const Contact> contacts, ContactUpdateStats& stats) {
  for (const Contact& c : contacts) {
    stats.points += uint64_t(c.count);
    for (const ContactPoint& p : c.used())
      stats.max_penetration = std::max(stats.max_penetration, -p.gap);
  }
}

}  // namespace

const ContactKnowledge& ContactSet::set_aside() {
  ContactKnowledge& place = kept_valid_ ? old_ : kept_;
  kept_valid_ = true;
  std::swap(now_, place);
  return place;
}

void ContactSet::begin_tick() {
  kept_valid_ = false;
  resting_.begin_tick();
}

void ContactSet::go_back() {
  if (kept_valid_) std::swap(now_, kept_);
  kept_valid_ = false;
  may_rest_ = true;
  resting_.go_back();
}

std::vector<const Contact*> ContactSet::resting() const {
  std::vector<const Contact*> out;
  out.reserve(resting_.contacts());
  resting_.for_piles([&out](const ContactKnowledge& pile) {
    for (const Contact& c : pile.contacts) out.push_back(&c);
  });
  std::ranges::sort(out, {}, &key_of);
  return out;
}

std::vector<const Contact*> ContactSet::all() const {
  std::vector<const Contact*> now;
  now.reserve(now_.contacts.size());
  for (const Contact& c : now_.contacts) now.push_back(&c);
  if (resting_.empty()) return now;
  std::vector<const Contact*> out;
  out.reserve(size());
  std::ranges::merge(now, resting(), std::back_inserter(out), {}, &key_of, &key_of);
  return out;
}

void ContactSet::clear() {
  assign({});
}

void ContactSet::assign(std::vector<Contact> contacts) {
  set_aside();
  may_rest_ = true;
  now_.contacts = std::move(contacts);
  now_.seen.clear();
  now_.pieces.clear();
  resting_.drop();
}

void ContactSet::exchange(std::vector<Contact> contacts) {
  const ContactKnowledge& before = set_aside();
  may_rest_ = true;
  now_.contacts = std::move(contacts);
  now_.seen = before.seen;
  now_.pieces = before.pieces;
}

ContactKnowledge ContactSet::take_out(const std::function<bool(const ContactKey&)>& which) {
  const ContactKnowledge& before = set_aside();
  may_rest_ = true;
  ContactKnowledge out;
  now_.clear();
  for (const Contact& c : before.contacts) (which(c.key) ? out : now_).contacts.push_back(c);
  for (const CachedPair& s : before.seen) (which(s.pair) ? out : now_).seen.push_back(s);
  for (const CachedShapes& s : before.pieces) (which(s.pair) ? out : now_).pieces.push_back(s);
  return out;
}

void ContactSet::put_in(const ContactKnowledge& taken) {
  merge(now_, taken, both_);
  std::swap(now_, both_);
  may_rest_ = true;
}

void ContactSet::find_chunk(const ContactKnowledge& old, std::span<const ProxyPair> pairs,
                            const PairContacts& finder, Chunk& out) {
  out.sources.clear();
  out.sights.clear();
  out.contacts = out.looks = 0;
  HistoryCursor history(old, finder.key(pairs.front()));
  for (const ProxyPair& pair : pairs) {
    if (stop_requested()) break;
    const PairSide &a = finder.sides[pair.a], &b = finder.sides[pair.b];
    if (a.body == b.body || (!a.dynamic && !b.dynamic)) continue;
    PairHistory before = history.at(finder.key(pair));
    Source source{pair, before.contacts};
    const size_t manifolds = out.sights.manifolds.size(), looks = out.sights.seen.size();
    if (in_pieces(a, b)) {
      before.pieces = history.pieces_of(finder.key(pair));
      source.carried = CompoundPair(finder, a, b, before).look(out.sights);
    } else if (finder.knows(pair, before)) {
      source.look = before.seen;
      source.carried = true;
      source.looks = 1;
    } else {
      finder.look(pair, before, out.sights);
    }
    source.contacts =
        uint32_t(source.carried ? before.contacts.size() : out.sights.manifolds.size() - manifolds);
    if (!source.look) source.looks = uint32_t(out.sights.seen.size() - looks);
    if (source.contacts + source.looks == 0) continue;
    out.contacts += source.contacts;
    out.looks += source.looks;
    out.sources.push_back(source);
  }
}

/// Writes the contacts of a chunk, found or carried along, to their place in the list.
void ContactSet::join(Chunk& chunk, const PairContacts& finder) {
  chunk.stats = {};
  std::span<const Manifold> manifolds = chunk.sights.manifolds;
  std::span<const ShapesOfPair> shapes = chunk.sights.shapes;
  auto look = chunk.sights.seen.begin();
  const auto contacts = std::span(now_.contacts).subspan(chunk.first_contact, chunk.contacts);
  auto seen = now_.seen.begin() + std::ptrdiff_t(chunk.first_look);
  std::ranges::copy(chunk.sights.pieces, now_.pieces.begin() + std::ptrdiff_t(chunk.first_piece));
  size_t at = 0;
  for (size_t k = 0; k < chunk.sources.size(); ++k) {
    constexpr size_t ahead = tolerances::pairs_ahead;
    const Source& source = chunk.sources[k];
    const Source& later = chunk.sources[std::min(k + ahead, chunk.sources.size() - 1)];
    prefetch<sizeof(ContactHead) + sizeof(ContactPoint)>(later.before.data());
    if (at + ahead < contacts.size())
      prefetch_to_write<sizeof(ContactHead) + sizeof(ContactPoint)>(&contacts[at + ahead]);
    const auto place = contacts.subspan(at, source.contacts);
    at += source.contacts;
    chunk.stats.carried += source.carried;
    if (source.look)
      *seen++ = *source.look;
    else
      for (uint32_t i = 0; i < source.looks; ++i) *seen++ = *look++;
    const PairSide &a = finder.sides[source.pair.a], &b = finder.sides[source.pair.b];
    if (source.carried) {
      std::ranges::copy(source.before, place.begin());
      for (Contact& c : place) carry_along(c, a, b);
      continue;
    }
    const size_t in_shapes = in_pieces(a, b) ? place.size() : 0;
    finder.make(source.pair, source.before, manifolds.first(place.size()), shapes.first(in_shapes),
                place);
    manifolds = manifolds.subspan(place.size());
    shapes = shapes.subspan(in_shapes);
  }
  count_points(contacts, chunk.stats);
}

/// Stores away contacts between bodies that are both no longer active.
void ContactSet::put_away(const ContactKnowledge& old, std::span<const RigidBody> bodies) {
  settled_.clear();
  const auto rest = [&](const ContactKey& key) {
    return !is_active(bodies[key.body_a]) && !is_active(bodies[key.body_b]);
  };
  for (const Contact& c : old.contacts)
    if (rest(c.key)) settled_.contacts.push_back(c);
  for (const CachedPair& s : old.seen)
    if (rest(s.pair)) settled_.seen.push_back(s);
  for (const CachedShapes& s : old.pieces)
    if (rest(s.pair)) settled_.pieces.push_back(s);
  if (!settled_.empty()) resting_.add(settled_, bodies);
}

/// Moves contacts that were stored away to roused_ if one of their bodies is active again, because
/// something from outside woke it. Returns whether there are any.
bool ContactSet::rouse_active(std::span<const RigidBody> bodies, const ProxySet& proxies) {
  roused_.clear();
  if (resting_.empty()) return false;
  // kinematic; they belong to no pile. Gathered where any body may have changed
  std::vector<uint32_t> started;
  for (const uint32_t proxy : proxies.news.moving) {
    const uint32_t body = proxies.refs[proxy].body;
    if (bodies[body].dynamic())
      resting_.take(body, roused_);
    else if (proxies.news.all)
      started.push_back(body);  // ascending
  }
  if (!started.empty()) resting_.take_all_of(started, roused_);
  roused_.sort();
  return !roused_.empty();
}

/// Keeps those roused contacts whose bodies are both still at rest: their pairs were not examined
/// in this update, unless the pair is in now_.seen. A body that lies on them may wake them later.
void ContactSet::append_resting(std::span<const RigidBody> bodies) {
  const auto seeks = [&](const ContactKey& key) {
    return is_active(bodies[key.body_a]) || is_active(bodies[key.body_b]);
  };
  std::erase_if(roused_.contacts, [&](const Contact& c) { return seeks(c.key); });
  std::erase_if(roused_.seen, [&](const CachedPair& s) {
    return seeks(s.pair) || std::binary_search(now_.seen.begin(), now_.seen.end(), s, pair_less);
  });
  std::erase_if(roused_.pieces, [&](const CachedShapes& s) {
    return !std::ranges::binary_search(roused_.seen, s.pair, {}, &CachedPair::pair);
  });
  merge(now_, roused_, both_);
  std::swap(now_, both_);
  may_rest_ = true;
}

bool ContactSet::rouse(std::span<const uint32_t> bodies) {
  roused_.clear();
  for (const uint32_t body : bodies) resting_.take(body, roused_);
  return merge_roused();
}

bool ContactSet::merge_roused() {
  if (roused_.empty()) return false;
  roused_.sort();
  merge(now_, roused_, both_);
  std::swap(now_, both_);
  may_rest_ = true;
  return true;
}

/// Gathers the sides of all proxies, or only of those in pairs where these are few.
void ContactSet::take_sides(std::span<const RigidBody> bodies, const ProxySet& proxies,
                            std::span<const ProxyPair> pairs, const Vec3& gravity, double h,
                            double margin, Crew& crew) {
  const bool few = pairs.size() < proxies.refs.size() / 4;
  paired_.clear();
  if (few) {
    for (const ProxyPair& p : pairs) paired_.insert(paired_.end(), {p.a, p.b});
    std::ranges::sort(paired_);
    paired_.erase(std::unique(paired_.begin(), paired_.end()), paired_.end());
  }
  sides_.resize(proxies.refs.size());
  for_chunks(&crew, few ? paired_.size() : sides_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const size_t i = few ? paired_[k] : k;
      sides_[i] = pair_side(bodies, proxies.refs[i], {gravity, h, margin});
    }
  });
}

/// resize(), in portions, so that growing to gigabytes can be stopped.
template <class T>
void make_room(std::vector<T>& list, size_t n) {
  constexpr size_t at_once = tolerances::room_at_once;
  if (n > list.capacity()) list.reserve(std::max(n, 2 * list.size()));
  while (list.size() + at_once < n && !stop_requested()) list.resize(list.size() + at_once);
  if (!stop_requested()) list.resize(n);
}

ContactUpdateStats ContactSet::update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                                      std::span<const ProxyPair> pairs, const Vec3& gravity,
                                      double h, double margin, Crew& crew, NarrowPhase narrow_phase,
                                      const HierarchyKind* hierarchy) {
  const size_t per_chunk = pairs_per_chunk(pairs.size());
  const size_t tasks = (pairs.size() + per_chunk - 1) / per_chunk;
  if (chunks_.size() < tasks) chunks_.resize(tasks);
  const std::span chunks(chunks_.data(), tasks);
  const ContactKnowledge& kept = set_aside();
  if (may_rest_ || !proxies.news.settled.empty() || (proxies.news.all && any_rests(bodies, crew)))
    put_away(kept, bodies);
  may_rest_ = false;
  const bool roused = rouse_active(bodies, proxies);
  if (roused) merge(kept, roused_, both_);
  const ContactKnowledge& old = roused ? both_ : kept;
  take_sides(bodies, proxies, pairs, gravity, h, margin, crew);
  const PairContacts finder{sides_, bodies, {gravity, h, margin}, narrow_phase, hierarchy};
  crew.each(tasks, [&](size_t c) {
    const size_t begin = c * per_chunk;
    const size_t here = std::min(pairs.size() - begin, per_chunk);
    find_chunk(old, pairs.subspan(begin, here), finder, chunks[c]);
  });
  size_t contacts = 0, looks = 0, pieces = 0;
  for (Chunk& chunk : chunks) {
    chunk.first_contact = std::exchange(contacts, contacts + chunk.contacts);
    chunk.first_look = std::exchange(looks, looks + chunk.looks);
    chunk.first_piece = std::exchange(pieces, pieces + chunk.sights.pieces.size());
  }
  make_room(now_.contacts, contacts);
  make_room(now_.seen, looks);
  make_room(now_.pieces, pieces);
  if (stop_requested()) {
    now_.clear();
    return {};
  }
  crew.each(tasks, [&](size_t c) {
    if (!stop_requested()) join(chunks[c], finder);
  });
  if (roused) append_resting(bodies);

  ContactUpdateStats stats;
  stats.points = resting_.points();
  stats.max_penetration = resting_.max_penetration();
  for (const Chunk& chunk : chunks) {
    stats.carried += chunk.stats.carried;
    stats.points += chunk.stats.points;
    stats.max_penetration = std::max(stats.max_penetration, chunk.stats.max_penetration);
  }
  if (roused) count_points(roused_.contacts, stats);
  stats.pairs = pairs.size();
  stats.contacts = size();
  return stats;
}

void ContactSet::scale_impulses(int parts, std::span<const RigidBody> bodies) {
  if (parts == 1) return;
  for (Contact& c : now_.contacts) {
    if (!is_active(bodies[c.key.body_a]) && !is_active(bodies[c.key.body_b])) continue;
    for (ContactPoint& p : c.used()) {
      p.normal_impulse *= parts;
      p.friction_impulse *= parts;
    }
  }
}

void ContactSet::add_memory(MemoryUse& use) const {
  for (const ContactKnowledge* k : {&now_, &kept_, &old_, &settled_, &roused_, &both_})
    use.contacts += heap_bytes(k->contacts, k->seen, k->pieces);
  use.contacts += heap_bytes(sides_, paired_, chunks_);
  resting_.add_memory(use);
  for (const Chunk& c : chunks_)
    use.contacts +=
        heap_bytes(c.sources, c.sights.manifolds, c.sights.shapes, c.sights.seen, c.sights.pieces);
}

void ContactSet::remove_body(uint32_t body) {
  roused_.clear();
  resting_.take_all_of(std::span(&body, 1), roused_);
  merge_roused();
  std::erase_if(now_.contacts,
                [body](const Contact& c) { return c.key.body_a == body || c.key.body_b == body; });
  const auto names = [body](const auto& s) {
    return s.pair.body_a == body || s.pair.body_b == body;
  };
  std::erase_if(now_.seen, names);
  std::erase_if(now_.pieces, names);
}

}  // namespace tumble
