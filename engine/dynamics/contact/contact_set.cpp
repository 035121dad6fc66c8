#include "engine/dynamics/contact/contact_set.hpp"

#include "engine/core/parallel.hpp"
#include "engine/dynamics/contact/pair_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tumble {

Vec3 contact_position(const Contact& contact, int i, std::span<const RigidBody> bodies) {
  const ContactPoint& p = contact.points[size_t(i)];
  return 0.5 * (bodies[contact.key.body_a].pose.point(p.anchor_a) +
                bodies[contact.key.body_b].pose.point(p.anchor_b));
}

Vec3 contact_impulse(const Contact& contact, int i) {
  const ContactPoint& p = contact.points[size_t(i)];
  return p.normal_impulse * contact.normal + p.friction_impulse;
}

CombinedMaterial combine(const Material& a, const Material& b) {
  return {std::sqrt(a.friction * b.friction), std::max(a.restitution, b.restitution)};
}

namespace {

constexpr size_t chunk_pairs = 16;

bool same_pair(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

bool key_less(const Contact& a, const Contact& b) {
  return a.key < b.key;
}

bool pair_less(const SeenPair& a, const SeenPair& b) {
  return a.pair < b.pair;
}

/// Walks through what was known before along with the pairs, which come in the same order.
class HistoryCursor {
 public:
  HistoryCursor(std::span<const Contact> contacts, std::span<const SeenPair> seen,
                const ContactKey& first)
      : contacts_(contacts),
        seen_(seen),
        contact_(
            std::lower_bound(contacts.begin(), contacts.end(), first,
                             [](const Contact& c, const ContactKey& key) { return c.key < key; })),
        look_(std::lower_bound(
            seen.begin(), seen.end(), first,
            [](const SeenPair& s, const ContactKey& key) { return s.pair < key; })) {}

  PairHistory at(const ContactKey& pair) {
    while (contact_ != contacts_.end() && contact_->key < pair) ++contact_;
    const auto begin = contact_;
    while (contact_ != contacts_.end() && same_pair(contact_->key, pair)) ++contact_;
    while (look_ != seen_.end() && look_->pair < pair) ++look_;
    const bool known = look_ != seen_.end() && same_pair(look_->pair, pair);
    return {{begin, contact_}, known ? &*look_ : nullptr};
  }

 private:
  std::span<const Contact> contacts_;
  std::span<const SeenPair> seen_;
  std::span<const Contact>::iterator contact_;
  std::span<const SeenPair>::iterator look_;
};

/// Appends what pairs at rest had, which were not looked at, and restores the order.
template <class T, class Body, class Less>
void keep_resting(const std::vector<T>& old, std::vector<T>& now, const Body& at_rest, Less less) {
  const auto middle = std::ptrdiff_t(now.size());
  for (const T& t : old)
    if (at_rest(t)) now.push_back(t);
  std::inplace_merge(now.begin(), now.begin() + middle, now.end(), less);
}

}  // namespace

const ContactSet::Knowledge& ContactSet::set_aside() {
  Knowledge& place = kept_valid_ ? old_ : kept_;
  kept_valid_ = true;
  std::swap(now_, place);
  return place;
}

void ContactSet::go_back() {
  if (kept_valid_) std::swap(now_, kept_);
  kept_valid_ = false;
}

void ContactSet::assign(std::vector<Contact> contacts) {
  set_aside();
  now_.contacts = std::move(contacts);
  now_.seen.clear();
}

void ContactSet::exchange(std::vector<Contact> contacts) {
  const Knowledge& before = set_aside();
  now_.contacts = std::move(contacts);
  now_.seen = before.seen;
}

void ContactSet::find_chunk(const Knowledge& old, const ProxySet& proxies,
                            std::span<const ProxyPair> pairs, const PairContacts& finder,
                            Knowledge& out) {
  static thread_local std::vector<Manifold> scratch;
  out.contacts.clear();
  out.seen.clear();
  out.carried = 0;
  const auto key_of = [&](const ProxyPair& p) -> ContactKey {
    const ShapeRef &a = proxies.refs[p.a], &b = proxies.refs[p.b];
    return {a.body, a.shape, b.body, b.shape, 0};
  };
  HistoryCursor history(old.contacts, old.seen, key_of(pairs.front()));
  for (const ProxyPair& p : pairs) {
    const ContactKey pair = key_of(p);
    if (pair.body_a == pair.body_b) continue;
    if (!finder.bodies[pair.body_a].dynamic() && !finder.bodies[pair.body_b].dynamic()) continue;
    if (finder.find(pair, history.at(pair), scratch, out.contacts, out.seen)) ++out.carried;
  }
}

ContactUpdateStats ContactSet::update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                                      std::span<const ProxyPair> pairs, const Vec3& gravity,
                                      double h, const RealtimeSettings& settings,
                                      tbb::task_arena& arena, NarrowPhase narrow_phase,
                                      const HierarchyKind* hierarchy) {
  const size_t chunk_count = (pairs.size() + chunk_pairs - 1) / chunk_pairs;
  if (chunks_.size() < chunk_count) chunks_.resize(chunk_count);
  const Knowledge& old = set_aside();
  const PairContacts finder{bodies,       gravity,  h, settings.speculative_margin,
                            narrow_phase, hierarchy};
  parallel_for(arena, chunk_count, [&](size_t c) {
    const size_t begin = c * chunk_pairs, end = std::min(pairs.size(), begin + chunk_pairs);
    find_chunk(old, proxies, pairs.subspan(begin, end - begin), finder, chunks_[c]);
  });
  now_.contacts.clear();
  now_.seen.clear();
  for (size_t c = 0; c < chunk_count; ++c) {
    now_.contacts.insert(now_.contacts.end(), chunks_[c].contacts.begin(),
                         chunks_[c].contacts.end());
    now_.seen.insert(now_.seen.end(), chunks_[c].seen.begin(), chunks_[c].seen.end());
  }
  const auto resting = [&](const ContactKey& key) {
    return !seeks_contacts(bodies[key.body_a]) && !seeks_contacts(bodies[key.body_b]);
  };
  keep_resting(
      old.contacts, now_.contacts, [&](const Contact& c) { return resting(c.key); }, key_less);
  keep_resting(
      old.seen, now_.seen, [&](const SeenPair& s) { return resting(s.pair); }, pair_less);

  ContactUpdateStats stats;
  stats.pairs = pairs.size();
  for (size_t c = 0; c < chunk_count; ++c) stats.carried += chunks_[c].carried;
  stats.contacts = now_.contacts.size();
  for (const Contact& c : now_.contacts) {
    stats.points += uint64_t(c.count);
    for (int i = 0; i < c.count; ++i) {
      stats.max_penetration = std::max(stats.max_penetration, -c.points[size_t(i)].gap);
    }
  }
  return stats;
}

void ContactSet::scale_impulses(int parts, std::span<const RigidBody> bodies) {
  if (parts == 1) return;
  for (Contact& c : now_.contacts) {
    if (!seeks_contacts(bodies[c.key.body_a]) && !seeks_contacts(bodies[c.key.body_b])) continue;
    for (ContactPoint& p : c.points) {
      p.normal_impulse *= parts;
      p.friction_impulse *= parts;
    }
  }
}

void ContactSet::remove_body(uint32_t body) {
  std::erase_if(now_.contacts,
                [body](const Contact& c) { return c.key.body_a == body || c.key.body_b == body; });
  std::erase_if(now_.seen, [body](const SeenPair& s) {
    return s.pair.body_a == body || s.pair.body_b == body;
  });
}

}  // namespace tumble
