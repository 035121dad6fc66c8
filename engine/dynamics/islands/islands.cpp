#include "engine/dynamics/islands/islands.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/islands/tolerances.hpp"
#include "engine/dynamics/islands/waking.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace tumble {

namespace {

constexpr uint8_t wakes = 1;     ///< a member is awake, or something moving touches or pulls it
constexpr uint8_t restless = 2;  ///< touched by a moving kinematic body

/// Whether the bodies touch now or will within the tick.
bool touching(const Contact& c, const RigidBody& a, const RigidBody& b, double h) {
  const double margin = tolerances::touching_margin;
  const double slop = tolerances::touching_of_margin *
                      std::min(contact_margin(a, margin), contact_margin(b, margin));
  for (int i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[size_t(i)];
    const Vec3 va = a.v + a.omega.cross(a.pose.direction(p.anchor_a));
    const Vec3 vb = b.v + b.omega.cross(b.pose.direction(p.anchor_b));
    if (p.gap + h * std::min(0.0, c.normal.dot(vb - va)) < slop) return true;
  }
  return false;
}

/// Properties of a body that matter here, in one byte: bodies are large.
constexpr uint8_t dynamic = 1;
constexpr uint8_t awake = 2;  ///< not asleep
constexpr uint8_t seeks = 4;  ///< is_active

uint8_t kind_of(const RigidBody& b) {
  return uint8_t((b.dynamic() ? dynamic : 0) | (b.asleep ? 0 : awake) | (is_active(b) ? seeks : 0));
}

bool dynamic_awake(uint8_t kind) {
  return (kind & dynamic) && (kind & awake);
}

/// The body whose island solves a contact between a and b: the lower of the dynamic ones; `none` if
/// one of these sleeps or none is dynamic.
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

/// out[i] = what(all[i]); reads each large object only once.
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
  use.bodies +=
      heap_bytes(islands, bodies, island_of, woken, involved, flag_, kind_, known_) + sets_.bytes();
  use.contacts += heap_bytes(contacts, ends, owner_);
  use.joints += heap_bytes(joints);
}

void IslandSet::append(const IslandSet& others) {
  const auto first = uint32_t(islands.size()), first_body = uint32_t(bodies.size());
  for (const Island& from : others.islands) {
    Island& island = islands.emplace_back();
    island.body_begin = first_body + from.body_begin;
    island.body_end = first_body + from.body_end;
    island.restless = from.restless;
  }
  bodies.insert(bodies.end(), others.bodies.begin(), others.bodies.end());
  island_of.resize(std::max(island_of.size(), others.island_of.size()), 0);
  for (const uint32_t slot : others.bodies) island_of[slot] = first + others.island_of[slot];
  woken.insert(woken.end(), others.woken.begin(), others.woken.end());
  std::ranges::sort(woken);
  std::vector<uint32_t> both;
  std::ranges::set_union(involved, others.involved, std::back_inserter(both));
  involved.swap(both);
}

/// The steps of build_islands.
class IslandBuilder {
 public:
  IslandBuilder(std::span<RigidBody> bodies, ContactSet& contacts, std::span<const BodyLink> links,
                double h, IslandSet& out, Crew* crew, const Roster* roster)
      : bodies_(bodies),
        contacts_(contacts),
        links_(links),
        h_(h),
        out_(out),
        crew_(crew),
        active_(roster ? roster->active() : std::span<const uint32_t>()),
        whole_(!roster || 4 * active_.size() >= bodies.size()) {}

  void run() {
    forget_last();
    do {
      gather_ends();
      involve();
      connect();
    } while (rouse());
    join_awake();
    number_islands();
    count();
    fill();
    for (const uint32_t i : out_.involved) out_.known_[i] = 0;
  }

 private:
  std::span<const Contact> touches() const { return std::as_const(contacts_).contacts(); }

  void forget_last() {
    for (const uint32_t i : out_.involved)
      if (i < out_.island_of.size()) out_.island_of[i] = 0;
    out_.involved.clear();
    out_.island_of.resize(bodies_.size(), 0);
    out_.flag_.resize(bodies_.size());
    out_.kind_.resize(bodies_.size());
    out_.known_.resize(bodies_.size(), 0);
    out_.woken.clear();
    out_.islands.clear();
  }

  void gather_ends() {
    gather(touches(), crew_, out_.ends, [](const Contact& c) -> IslandSet::Ends {
      return {c.key.body_a, c.key.body_b, uint16_t(c.count), c.restitution > 0,
              c.resists_turning()};
    });
  }

  void involve(uint32_t slot) {
    if (std::exchange(out_.known_[slot], uint8_t{1})) return;
    out_.kind_[slot] = kind_of(bodies_[slot]);
    out_.involved.push_back(slot);
  }

  void involve() {
    if (whole_) {
      if (!out_.involved.empty()) return;
      out_.involved.resize(bodies_.size());
      std::iota(out_.involved.begin(), out_.involved.end(), 0u);
      gather(std::span<const RigidBody>(bodies_), crew_, out_.kind_, &kind_of);
      return;
    }
    for (const uint32_t slot : active_) involve(slot);
    for (const IslandSet::Ends& end : out_.ends) involve(end.a), involve(end.b);
    for (const BodyLink& l : links_) {
      if (l.a != BodyLink::none) involve(l.a);
      involve(l.b);
    }
    std::ranges::sort(out_.involved);
  }

  /// Joins bodies that contacts connect, and marks the sets that must be awake.
  void connect_touching() {
    const std::span<const uint8_t> kind = out_.kind_;
    const std::span<const Contact> contacts = touches();
    for (size_t k = 0; k < out_.ends.size(); ++k) {
      const uint32_t a = out_.ends[k].a, b = out_.ends[k].b;
      const auto touch = [&] { return touching(contacts[k], bodies_[a], bodies_[b], h_); };
      if (kind[a] & kind[b] & dynamic) {
        if ((kind[a] & kind[b] & awake) || touch()) out_.sets_.join(a, b);
      } else {
        const uint32_t body = kind[a] & dynamic ? a : b, other = kind[a] & dynamic ? b : a;
        if ((kind[body] & dynamic) && (kind[other] & seeks) && touch())
          out_.flag_[body] |= wakes | restless;
      }
    }
  }

  /// The same for links.
  void connect_tied() {
    const std::span<const uint8_t> kind = out_.kind_;
    for (const BodyLink& l : links_) {
      if (l.a == BodyLink::none) continue;
      if (kind[l.a] & kind[l.b] & dynamic) {
        out_.sets_.join(l.a, l.b);
      } else {
        // A moving kinematic body pulls bodies that are linked with it.
        if ((kind[l.a] & dynamic) && (kind[l.b] & seeks)) out_.flag_[l.a] |= wakes | restless;
        if ((kind[l.b] & dynamic) && (kind[l.a] & seeks)) out_.flag_[l.b] |= wakes | restless;
      }
    }
  }

  void connect() {
    out_.sets_.reset(bodies_.size(), out_.involved);
    for (const uint32_t i : out_.involved) out_.flag_[i] = 0;
    connect_touching();
    connect_tied();
    all_awake_ = true;
    for (const uint32_t i : out_.involved) {
      if (dynamic_awake(out_.kind_[i])) out_.flag_[i] |= wakes;
      all_awake_ &= (out_.kind_[i] & awake) != 0;
      out_.flag_[out_.sets_.root(i)] |= out_.flag_[i];
    }
  }

  bool belongs(uint32_t i) {
    return (out_.kind_[i] & dynamic) && (out_.flag_[out_.sets_.root(i)] & wakes);
  }

  /// Brings back the contacts of sleeping bodies that will wake, since bodies that lie on them must
  /// wake too. Returns whether there were any.
  bool rouse() {
    if (all_awake_) return false;
    disturbed_.clear();
    for (const uint32_t i : out_.involved)
      if (!(out_.kind_[i] & awake) && contacts_.rests(i) && belongs(i)) disturbed_.push_back(i);
    return !disturbed_.empty() && contacts_.rouse(disturbed_);
  }

  /// Contacts with a gap too large to wake a sleeping body act as soon as something else wakes it.
  /// Both bodies must then be in one island.
  void join_awake() {
    if (all_awake_) return;
    for (const IslandSet::Ends& end : out_.ends) {
      if (!(out_.kind_[end.a] & out_.kind_[end.b] & dynamic)) continue;
      const uint32_t a = out_.sets_.root(end.a), b = out_.sets_.root(end.b);
      if (a == b || !(out_.flag_[a] & out_.flag_[b] & wakes)) continue;
      out_.sets_.join(a, b);
      out_.flag_[std::min(a, b)] |= out_.flag_[std::max(a, b)];
    }
  }

  void number_islands() {
    for (const uint32_t i : out_.involved) {
      if (!belongs(i)) continue;
      const uint32_t r = out_.sets_.root(i);
      if (!(out_.kind_[i] & awake)) {
        wake(bodies_[i]);
        out_.kind_[i] |= awake;
        out_.woken.push_back(i);
      }
      if (out_.island_of[r] == 0) {  // r <= i: the root is the first of its set
        out_.islands.emplace_back();
        out_.islands.back().restless = (out_.flag_[r] & restless) != 0;
        out_.island_of[r] = uint32_t(out_.islands.size());
      }
      out_.island_of[i] = out_.island_of[r];
      ++out_.islands[out_.island_of[i] - 1].body_end;
    }
  }

  void count() {
    out_.owner_.resize(out_.ends.size());
    for (size_t k = 0; k < out_.ends.size(); ++k) {
      const uint32_t body = owner(out_.ends[k].a, out_.ends[k].b, out_.kind_);
      out_.owner_[k] = body != none ? out_.island_of[body] : 0;
      if (body == none) continue;
      Island& island = out_.islands[out_.owner_[k] - 1];
      ++island.contact_end;
      island.points += out_.ends[k].points;
    }
    for (const BodyLink& l : links_) {
      const uint32_t body = owner(l, out_.kind_);
      if (body != none) ++out_.islands[out_.island_of[body] - 1].joint_end;
    }
  }

  /// Turns counts into ranges, then assigns each body, contact and joint to the next index of its
  /// island.
  void fill() {
    uint32_t body_at = 0, contact_at = 0, joint_at = 0;
    const auto open = [](uint32_t& begin, uint32_t& end, uint32_t& at) {
      begin = std::exchange(at, at + end);
      end = begin;
    };
    for (Island& island : out_.islands) {
      open(island.body_begin, island.body_end, body_at);
      open(island.contact_begin, island.contact_end, contact_at);
      open(island.joint_begin, island.joint_end, joint_at);
    }
    out_.bodies.resize(body_at);
    out_.contacts.resize(contact_at);
    out_.joints.resize(joint_at);
    for (const uint32_t i : out_.involved)
      if (out_.island_of[i]) out_.bodies[out_.islands[out_.island_of[i] - 1].body_end++] = i;
    for (uint32_t k = 0; k < out_.owner_.size(); ++k)
      if (out_.owner_[k]) out_.contacts[out_.islands[out_.owner_[k] - 1].contact_end++] = k;
    for (const BodyLink& l : links_) {
      const uint32_t body = owner(l, out_.kind_);
      if (body != none) out_.joints[out_.islands[out_.island_of[body] - 1].joint_end++] = l.joint;
    }
  }

  std::span<RigidBody> bodies_;
  ContactSet& contacts_;
  std::span<const BodyLink> links_;
  double h_;
  IslandSet& out_;
  Crew* crew_;
  std::span<const uint32_t> active_;
  bool whole_;  ///< all bodies count as involved: sorting a large part of them would not pay
  bool all_awake_ = true;
  std::vector<uint32_t> disturbed_;
};

void build_islands(std::span<RigidBody> bodies, ContactSet& contacts,
                   std::span<const BodyLink> links, double h, IslandSet& out, Crew* crew,
                   const Roster* roster) {
  IslandBuilder(bodies, contacts, links, h, out, crew, roster).run();
}

}  // namespace tumble
