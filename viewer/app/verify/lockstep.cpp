#include "viewer/app/verify/lockstep.hpp"

#include "engine/dynamics/simd/simd_target.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string body_name(const Frame& frame, size_t slot) {
  const std::string& name = frame.info(slot).name;
  return name.empty() ? fmt::format("body {}", slot) : name;
}

void see(Divergence& d, double distance, const std::string& what) {
  // Of equally distant ones the first is named.
  if (!(distance > d.distance)) return;
  d.distance = distance;
  d.what = what;
}

bool is_live(const Frame& frame, size_t slot) {
  return slot < frame.body_slots() && !frame.body(slot).id.is_null();
}

/// The slots of a body that exists in both frames; `nowhere` for the frame that lacks it.
struct SlotPair {
  size_t a, b;
};
constexpr size_t nowhere = size_t(-1);

/// In the order of A's slots, then those that only B has. In most worlds a body has the same slot
/// in both.
std::vector<SlotPair> pairs_of_bodies(const Frame& a, const Frame& b) {
  std::vector<SlotPair> pairs;
  std::map<std::string, size_t> others;  // of B, by name
  std::vector<size_t> of_a, of_b;
  const size_t slots = std::max(a.body_slots(), b.body_slots());
  for (size_t slot = 0; slot < slots; ++slot) {
    const bool in_a = is_live(a, slot), in_b = is_live(b, slot);
    if (in_a && in_b && a.info(slot).name == b.info(slot).name) {
      pairs.push_back({slot, slot});
      continue;
    }
    if (in_a) of_a.push_back(slot);
    if (in_b) of_b.push_back(slot);
  }
  for (const size_t slot : of_b)
    if (!b.info(slot).name.empty()) others.emplace(b.info(slot).name, slot);
  std::set<size_t> taken;
  for (const size_t slot : of_a) {
    const auto found = others.find(a.info(slot).name);
    pairs.push_back({slot, found == others.end() ? nowhere : found->second});
    if (found != others.end()) taken.insert(found->second);
    others.erase(a.info(slot).name);
  }
  for (const size_t slot : of_b)
    if (!taken.contains(slot)) pairs.push_back({nowhere, slot});
  return pairs;
}

void compare_bodies(const Frame& a, const Frame& b, Divergence& d) {
  for (const SlotPair& pair : pairs_of_bodies(a, b)) {
    if (pair.a == nowhere || pair.b == nowhere) {
      d.same_bits = false;
      see(d, infinite, pair.b == nowhere ? body_name(a, pair.a) : body_name(b, pair.b));
      continue;
    }
    const BodyFrame &p = a.body(pair.a), &q = b.body(pair.b);
    if (p.pose.x == q.pose.x && p.pose.q.coeffs() == q.pose.q.coeffs() && p.v == q.v &&
        p.omega == q.omega)
      continue;
    d.same_bits = false;
    see(d, (p.pose.x - q.pose.x).norm(), body_name(a, pair.a));
    d.angle = std::max(d.angle, p.pose.q.angularDistance(q.pose.q));
    d.speed = std::max(d.speed, (p.v - q.v).norm());
  }
}

/// Contacts by pair of bodies, under A's slots; contacts of a pair keep their order.
using ContactsOfPairs = std::map<std::pair<uint32_t, uint32_t>, std::vector<ContactFrame>>;

ContactsOfPairs contacts_of(const Frame& frame, const std::vector<SlotPair>& pairs, bool is_b) {
  std::map<uint32_t, uint32_t> called;
  // Bodies that only B has come after all of A's.
  for (const SlotPair& pair : pairs)
    if (is_b && pair.b != nowhere && pair.a != pair.b)
      called[uint32_t(pair.b)] =
          pair.a == nowhere ? uint32_t(1u << 31) + uint32_t(pair.b) : uint32_t(pair.a);
  const auto name = [&](BodyId id) {
    const auto found = called.find(id.index);
    return found == called.end() ? id.index : found->second;
  };
  ContactsOfPairs out;
  frame.for_contacts(
      [&](const ContactFrame& c) { out[std::minmax(name(c.a), name(c.b))].push_back(c); });
  return out;
}

std::string contact_names(const Frame& frame, const ContactFrame& c) {
  const auto name = [&](BodyId id) {
    return id.index < frame.body_slots() ? body_name(frame, id.index) : std::string("the world");
  };
  return fmt::format("{} and {}", name(c.a), name(c.b));
}

ContactDifference only_in(const char* which, const Frame& frame, const ContactFrame& c) {
  return {c.a, c.b, c.x_world, fmt::format("{}: only in {}", contact_names(frame, c), which)};
}

/// A contact of B with the ids of A's bodies of the same names; null if there is none.
ContactDifference as_in_a(ContactDifference found, const Frame& a,
                          const std::vector<SlotPair>& pairs) {
  for (BodyId* id : {&found.a, &found.b}) {
    const auto pair = std::ranges::find(pairs, size_t(id->index), &SlotPair::b);
    *id = pair == pairs.end() || pair->a == nowhere ? BodyId{} : a.body(pair->a).id;
  }
  return found;
}

void compare_particles(const ParticleFrame& a, const ParticleFrame& b, Divergence& d) {
  const size_t common = std::min(a.x.size(), b.x.size());
  for (size_t i = 0; i < common; ++i) {
    if (a.x[i] == b.x[i]) continue;
    d.same_bits = false;
    see(d, (a.x[i] - b.x[i]).norm(), fmt::format("{} particle {}", a.name, i));
  }
  if (a.x.size() == b.x.size()) return;
  d.same_bits = false;
  see(d, infinite, fmt::format("{} particle {}", a.name, common));
}

Status step_one(const LockstepSide& side, const char* which) {
  const SimdTarget target(side.simd);
  const auto done = side.world.step();
  if (done) return {};
  Error error = done.error();
  error.place = error.place.empty() ? which : fmt::format("{}: {}", which, error.place);
  return error;
}

}  // namespace

Divergence divergence(const Frame& a, const Frame& b) {
  Divergence d;
  d.time = a.time;
  d.tick_a = a.tick;
  d.tick_b = b.tick;
  compare_bodies(a, b, d);
  const ParticleFrame empty;
  for (size_t i = 0; i < std::max(a.particles.size(), b.particles.size()); ++i) {
    const auto of = [&](const Frame& f) -> const ParticleFrame& {
      return i < f.particles.size() && f.particles[i] ? *f.particles[i] : empty;
    };
    compare_particles(of(a), of(b), d);
  }
  return d;
}

std::optional<ContactDifference> first_contact_difference(const Frame& a, const Frame& b) {
  const std::vector<SlotPair> pairs = pairs_of_bodies(a, b);
  const ContactsOfPairs of_a = contacts_of(a, pairs, false), of_b = contacts_of(b, pairs, true);
  auto p = of_a.begin();
  auto q = of_b.begin();
  const auto at_this_tick = [&](ContactDifference found) {
    found.tick = a.tick;
    return found;
  };
  while (p != of_a.end() || q != of_b.end()) {
    if (q == of_b.end() || (p != of_a.end() && p->first < q->first))
      return at_this_tick(only_in("A", a, p->second.front()));
    if (p == of_a.end() || q->first < p->first)
      return at_this_tick(as_in_a(only_in("B", b, q->second.front()), a, pairs));
    const size_t common = std::min(p->second.size(), q->second.size());
    for (size_t i = 0; i < common; ++i) {
      const ContactFrame &c = p->second[i], &e = q->second[i];
      if (c.impulse == e.impulse && c.gap == e.gap && c.x_world == e.x_world) continue;
      return at_this_tick(
          {c.a, c.b, c.x_world,
           fmt::format("{}: {:.4g} N s and {:.4g} N s, gaps {:.3g} mm and {:.3g} mm",
                       contact_names(a, c), c.impulse.norm(), e.impulse.norm(), 1000 * c.gap,
                       1000 * e.gap)});
    }
    if (p->second.size() > common) return at_this_tick(only_in("A", a, p->second[common]));
    if (q->second.size() > common)
      return at_this_tick(as_in_a(only_in("B", b, q->second[common]), a, pairs));
    ++p, ++q;
  }
  return std::nullopt;
}

Status run_lockstep(const LockstepSide& side_a, const LockstepSide& side_b, double seconds,
                    const std::function<bool(const Divergence&)>& each) {
  World &a = side_a.world, &b = side_b.world;
  // Times are n / rate with integers, so equal times are detected exactly over a common
  // denominator.
  const TickRate ra = a.settings().tick, rb = b.settings().tick;
  const auto time_a = [&] { return int64_t(a.tick()) * ra.den * rb.num; };
  const auto time_b = [&] { return int64_t(b.tick()) * rb.den * ra.num; };
  if (!each(divergence(*a.frame(), *b.frame()))) return {};
  while (std::min(a.time(), b.time()) < seconds - 0.5 * std::min(ra.tick(), rb.tick())) {
    const int64_t ta = time_a(), tb = time_b();
    if (ta <= tb)
      if (const Status s = step_one(side_a, "A"); !s) return s;
    if (tb <= ta)
      if (const Status s = step_one(side_b, "B"); !s) return s;
    if (time_a() == time_b() && !each(divergence(*a.frame(), *b.frame()))) return {};
  }
  return {};
}

}  // namespace tumble
