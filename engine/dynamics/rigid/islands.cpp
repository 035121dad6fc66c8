#include "engine/dynamics/rigid/islands.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/rigid/sleeping.hpp"

#include <algorithm>

namespace tumble {

namespace {

constexpr uint8_t wakes = 1;     ///< a member is awake, or something moving touches it
constexpr uint8_t restless = 2;  ///< touched by a moving kinematic body

/// Whether the bodies touch now or will within the tick.
bool touching(const Contact& c, const RigidBody& a, const RigidBody& b, double h) {
  const double slop = 0.05 * std::min(contact_margin(a, 0.02), contact_margin(b, 0.02));
  for (int i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[size_t(i)];
    const Vec3 va = a.v + a.omega.cross(a.pose.direction(p.anchor_a));
    const Vec3 vb = b.v + b.omega.cross(b.pose.direction(p.anchor_b));
    if (p.gap + h * std::min(0.0, c.normal.dot(vb - va)) < slop) return true;
  }
  return false;
}

/// What matters of a body, in a byte: bodies are large.
constexpr uint8_t dynamic = 1;
constexpr uint8_t awake = 2;  ///< not asleep
constexpr uint8_t seeks = 4;  ///< seeks_contacts

uint8_t kind_of(const RigidBody& b) {
  return uint8_t((b.dynamic() ? dynamic : 0) | (b.asleep ? 0 : awake) |
                 (seeks_contacts(b) ? seeks : 0));
}

bool dynamic_awake(uint8_t kind) {
  return (kind & dynamic) && (kind & awake);
}

/// The body whose island solves what acts between a and b: the lower of the dynamic ones, or `none`
/// when a body of it sleeps or none is dynamic.
constexpr uint32_t none = ~uint32_t{0};
uint32_t owner(uint32_t a, uint32_t b, std::span<const uint8_t> kind) {
  if (kind[a] & kind[b] & dynamic) return kind[a] & kind[b] & awake ? a : none;
  if (dynamic_awake(kind[a])) return a;
  return dynamic_awake(kind[b]) ? b : none;
}

uint32_t owner(const BodyLink& l, std::span<const uint8_t> kind) {
  if (l.joint == BodyLink::none) return none;
  if (l.a != BodyLink::none && dynamic_awake(kind[l.a])) return l.a;
  return dynamic_awake(kind[l.b]) ? l.b : none;
}

/// Joins what contacts act on and notes which sets must be awake.
void connect_touching(std::span<const RigidBody> bodies, std::span<const Contact> contacts,
                      std::span<const IslandSet::Ends> ends, std::span<const uint8_t> kind,
                      double h, DisjointSets& sets, std::span<uint8_t> flag) {
  for (size_t k = 0; k < ends.size(); ++k) {
    const uint32_t a = ends[k].a, b = ends[k].b;
    const auto touch = [&] { return touching(contacts[k], bodies[a], bodies[b], h); };
    if (kind[a] & kind[b] & dynamic) {
      if ((kind[a] & kind[b] & awake) || touch()) sets.join(a, b);
    } else {
      const uint32_t body = kind[a] & dynamic ? a : b, other = kind[a] & dynamic ? b : a;
      if ((kind[body] & dynamic) && (kind[other] & seeks) && touch())
        flag[body] |= wakes | restless;
    }
  }
}

/// The same for what ties bodies together.
void connect_tied(std::span<const BodyLink> links, std::span<const uint8_t> kind,
                  DisjointSets& sets, std::span<uint8_t> flag) {
  for (const BodyLink& l : links) {
    if (l.a == BodyLink::none) continue;
    if (kind[l.a] & kind[l.b] & dynamic) {
      sets.join(l.a, l.b);
    } else {
      // A kinematic body that moves pulls what is tied to it.
      if ((kind[l.a] & dynamic) && (kind[l.b] & seeks)) flag[l.a] |= wakes | restless;
      if ((kind[l.b] & dynamic) && (kind[l.a] & seeks)) flag[l.b] |= wakes | restless;
    }
  }
}

/// Contacts that are too far to wake a sleeping body act as soon as something else wakes it: both
/// ends belong to one island then, or two would solve the same body.
void join_awake(std::span<const IslandSet::Ends> ends, std::span<const uint8_t> kind,
                DisjointSets& sets, std::span<uint8_t> flag) {
  for (const IslandSet::Ends& end : ends) {
    if (!(kind[end.a] & kind[end.b] & dynamic)) continue;
    const uint32_t a = sets.root(end.a), b = sets.root(end.b);
    if (a == b || !(flag[a] & flag[b] & wakes)) continue;
    sets.join(a, b);
    flag[std::min(a, b)] |= flag[std::max(a, b)];
  }
}

/// out[i] = what(all[i]): one look at each of what is large.
template <class T, class Out, class What>
void gather(std::span<const T> all, Crew* crew, std::vector<Out>& out, const What& what) {
  out.resize(all.size());
  for_chunks(crew, all.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      prefetch_ahead(all, i, 12);
      out[i] = what(all[i]);
    }
  });
}

}  // namespace

void IslandSet::add_memory(MemoryUse& use) const {
  use.bodies += heap_bytes(islands, bodies, island_of, flag_, kind_) + sets_.bytes();
  use.contacts += heap_bytes(contacts, ends, owner_);
  use.joints += heap_bytes(joints);
}

void build_islands(std::span<RigidBody> bodies, const ContactSet& contacts,
                   std::span<const BodyLink> links, double h, IslandSet& out, Crew* crew) {
  const auto n = uint32_t(bodies.size());
  DisjointSets& sets = out.sets_;
  std::vector<uint8_t>& flag = out.flag_;
  std::vector<uint8_t>& kind = out.kind_;
  const std::span<const Contact> touches = contacts.contacts();
  sets.reset(n);
  flag.assign(n, 0);
  gather(std::span<const RigidBody>(bodies), crew, kind, &kind_of);
  gather(touches, crew, out.ends, [](const Contact& c) -> IslandSet::Ends {
    return {c.key.body_a, c.key.body_b, uint32_t(c.count)};
  });
  const std::span<const IslandSet::Ends> ends = out.ends;
  connect_touching(bodies, touches, ends, kind, h, sets, flag);
  connect_tied(links, kind, sets, flag);

  bool all_awake = true;
  for (uint32_t i = 0; i < n; ++i) {
    if (dynamic_awake(kind[i])) flag[i] |= wakes;
    all_awake &= (kind[i] & awake) != 0;
    flag[sets.root(i)] |= flag[i];
  }
  if (!all_awake) join_awake(ends, kind, sets, flag);
  out.islands.clear();
  out.island_of.assign(n, 0);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t r = sets.root(i);
    if (!(kind[i] & dynamic) || !(flag[r] & wakes)) continue;
    if (!(kind[i] & awake)) {
      wake(bodies[i]);
      kind[i] |= awake;
    }
    if (out.island_of[r] == 0) {  // r <= i: the root is the first of its set
      out.islands.emplace_back();
      out.islands.back().restless = (flag[r] & restless) != 0;
      out.island_of[r] = uint32_t(out.islands.size());
    }
    out.island_of[i] = out.island_of[r];
    ++out.islands[out.island_of[i] - 1].body_end;
  }
  out.owner_.resize(ends.size());
  for (size_t k = 0; k < ends.size(); ++k) {
    const uint32_t body = owner(ends[k].a, ends[k].b, kind);
    out.owner_[k] = body != none ? out.island_of[body] : 0;
    if (body == none) continue;
    Island& island = out.islands[out.owner_[k] - 1];
    ++island.contact_end;
    island.points += ends[k].points;
  }

  for (const BodyLink& l : links) {
    const uint32_t body = owner(l, kind);
    if (body != none) ++out.islands[out.island_of[body] - 1].joint_end;
  }

  // Counts become ranges, then each body, contact and joint goes to the next place of its island.
  uint32_t body_at = 0, contact_at = 0, joint_at = 0;
  for (Island& island : out.islands) {
    island.body_begin = body_at;
    body_at += island.body_end;
    island.body_end = island.body_begin;
    island.contact_begin = contact_at;
    contact_at += island.contact_end;
    island.contact_end = island.contact_begin;
    island.joint_begin = joint_at;
    joint_at += island.joint_end;
    island.joint_end = island.joint_begin;
  }
  out.bodies.resize(body_at);
  out.contacts.resize(contact_at);
  out.joints.resize(joint_at);
  for (uint32_t i = 0; i < n; ++i) {
    if (out.island_of[i]) out.bodies[out.islands[out.island_of[i] - 1].body_end++] = i;
  }
  for (uint32_t k = 0; k < out.owner_.size(); ++k) {
    if (out.owner_[k]) out.contacts[out.islands[out.owner_[k] - 1].contact_end++] = k;
  }
  for (const BodyLink& l : links) {
    const uint32_t body = owner(l, kind);
    if (body != none) out.joints[out.islands[out.island_of[body] - 1].joint_end++] = l.joint;
  }
}

}  // namespace tumble
