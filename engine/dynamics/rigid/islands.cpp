#include "engine/dynamics/rigid/islands.hpp"

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

bool dynamic_awake(const RigidBody& b) {
  return b.dynamic() && !b.asleep;
}

/// The island that solves a contact: the lower of its dynamic bodies, or `none` when a body of it
/// sleeps or none is dynamic.
constexpr uint32_t none = ~uint32_t{0};
uint32_t owner(const Contact& c, std::span<const RigidBody> bodies) {
  const RigidBody& a = bodies[c.key.body_a];
  const RigidBody& b = bodies[c.key.body_b];
  if (a.dynamic() && b.dynamic()) return a.asleep || b.asleep ? none : c.key.body_a;
  if (dynamic_awake(a)) return c.key.body_a;
  if (dynamic_awake(b)) return c.key.body_b;
  return none;
}

uint32_t owner(const BodyLink& l, std::span<const RigidBody> bodies) {
  if (l.joint == BodyLink::none) return none;
  if (l.a != BodyLink::none && dynamic_awake(bodies[l.a])) return l.a;
  return dynamic_awake(bodies[l.b]) ? l.b : none;
}

/// Joins what acts on each other and notes which sets must be awake.
void connect(std::span<const RigidBody> bodies, const ContactSet& contacts,
             std::span<const BodyLink> links, double h, DisjointSets& sets,
             std::vector<uint8_t>& flag) {
  for (const Contact& c : contacts.contacts()) {
    const RigidBody& a = bodies[c.key.body_a];
    const RigidBody& b = bodies[c.key.body_b];
    const bool both_awake = !a.asleep && !b.asleep;
    if (a.dynamic() && b.dynamic()) {
      if (both_awake || touching(c, a, b, h)) sets.join(c.key.body_a, c.key.body_b);
    } else {
      const uint32_t body = a.dynamic() ? c.key.body_a : c.key.body_b;
      const RigidBody& other = a.dynamic() ? b : a;
      if (bodies[body].dynamic() && seeks_contacts(other) && touching(c, a, b, h)) {
        flag[body] |= wakes | restless;
      }
    }
  }
  for (const BodyLink& l : links) {
    if (l.a == BodyLink::none) continue;
    if (bodies[l.a].dynamic() && bodies[l.b].dynamic()) {
      sets.join(l.a, l.b);
    } else {
      // A kinematic body that moves pulls what is tied to it.
      if (bodies[l.a].dynamic() && seeks_contacts(bodies[l.b])) flag[l.a] |= wakes | restless;
      if (bodies[l.b].dynamic() && seeks_contacts(bodies[l.a])) flag[l.b] |= wakes | restless;
    }
  }
}

/// Contacts that are too far to wake a sleeping body act as soon as something else wakes it: both
/// ends belong to one island then, or two would solve the same body.
void join_awake(std::span<const RigidBody> bodies, const ContactSet& contacts, DisjointSets& sets,
                std::vector<uint8_t>& flag) {
  for (const Contact& c : contacts.contacts()) {
    if (!bodies[c.key.body_a].dynamic() || !bodies[c.key.body_b].dynamic()) continue;
    const uint32_t a = sets.root(c.key.body_a), b = sets.root(c.key.body_b);
    if (a == b || !(flag[a] & flag[b] & wakes)) continue;
    sets.join(a, b);
    flag[std::min(a, b)] |= flag[std::max(a, b)];
  }
}

}  // namespace

void IslandSet::add_memory(MemoryUse& use) const {
  use.bodies += heap_bytes(islands, bodies, island_of, flag_) + sets_.bytes();
  use.contacts += heap_bytes(contacts);
  use.joints += heap_bytes(joints);
}

void build_islands(std::span<RigidBody> bodies, const ContactSet& contacts,
                   std::span<const BodyLink> links, double h, IslandSet& out) {
  const auto n = uint32_t(bodies.size());
  DisjointSets& sets = out.sets_;
  std::vector<uint8_t>& flag = out.flag_;
  sets.reset(n);
  flag.assign(n, 0);
  connect(bodies, contacts, links, h, sets, flag);

  for (uint32_t i = 0; i < n; ++i) {
    if (dynamic_awake(bodies[i])) flag[i] |= wakes;
    flag[sets.root(i)] |= flag[i];
  }
  join_awake(bodies, contacts, sets, flag);
  out.islands.clear();
  out.island_of.assign(n, 0);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t r = sets.root(i);
    if (!bodies[i].dynamic() || !(flag[r] & wakes)) continue;
    if (bodies[i].asleep) wake(bodies[i]);
    if (out.island_of[r] == 0) {  // r <= i: the root is the first of its set
      out.islands.emplace_back();
      out.islands.back().restless = (flag[r] & restless) != 0;
      out.island_of[r] = uint32_t(out.islands.size());
    }
    out.island_of[i] = out.island_of[r];
    ++out.islands[out.island_of[i] - 1].body_end;
  }
  for (const Contact& c : contacts.contacts()) {
    const uint32_t body = owner(c, bodies);
    if (body != none) ++out.islands[out.island_of[body] - 1].contact_end;
  }

  for (const BodyLink& l : links) {
    const uint32_t body = owner(l, bodies);
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
  for (uint32_t k = 0; k < contacts.size(); ++k) {
    const uint32_t body = owner(contacts.contacts()[k], bodies);
    if (body != none) out.contacts[out.islands[out.island_of[body] - 1].contact_end++] = k;
  }
  for (const BodyLink& l : links) {
    const uint32_t body = owner(l, bodies);
    if (body != none) out.joints[out.islands[out.island_of[body] - 1].joint_end++] = l.joint;
  }
}

}  // namespace tumble
