#include "engine/dynamics/realtime/tick_parts.hpp"

#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace tumble {
namespace {

/// Thickness of the thinnest relevant shape of a body [m]; infinity if none is. A sharp rim does
/// not count as thin: the least is `thin_of_size`.
double thickness(const RigidBody& body, bool close) {
  double least = std::numeric_limits<double>::infinity();
  if (!body.dynamic()) return least;
  for (const BodyShape& s : body.shapes) {
    if (s.shape->is_mesh()) {
      const MeshSurface& surface = s.shape->polyhedral()->surface();
      least =
          std::min(least, std::max(surface.min_thickness, tolerances::thin_of_size * surface.size));
    } else if (close) {
      least = std::min(least, tolerances::close_of_radius * body.inner_radius);
    } else if (body.looks_far) {
      least = std::min(least, body.inner_radius);
    }
  }
  return least;
}

/// Bound on the speed of any point of one body relative to the other [m/s].
double passing_speed(const RigidBody& a, const RigidBody& b) {
  double speed = (a.v - b.v).norm();
  for (const RigidBody* body : {&a, &b})
    if (!body->omega.isZero(0)) speed += body->omega.norm() * body->bounding_radius;
  return speed;
}

/// The number of parts that a pair asks for.
int parts_for(const TickParts::Tick& tick, const ProxyPair& pair, int most) {
  const RigidBody& a = tick.bodies[tick.proxies.refs[pair.a].body];
  const RigidBody& b = tick.bodies[tick.proxies.refs[pair.b].body];
  const double thin = std::min(thickness(a, tick.close), thickness(b, tick.close));
  if (!std::isfinite(thin)) return 1;
  const double gained = tick.close ? tick.gravity * tick.h : 0;
  const double wanted =
      std::ceil((passing_speed(a, b) + gained) * tick.h / (tolerances::passed_of_thickness * thin));
  return int(std::clamp(wanted, 1.0, double(most)));
}

/// Calls f(a, b) for the slots of all pairs of bodies that may act on each other in the tick,
/// except for links with the world.
template <class F>
void for_neighbours(const TickParts::Tick& tick, const F& f) {
  for (const ProxyPair& pair : tick.pairs)
    f(tick.proxies.refs[pair.a].body, tick.proxies.refs[pair.b].body);
  for (const BodyLink& l : tick.links)
    if (l.a != BodyLink::none) f(l.a, l.b);
  // A body that wakes brings back all contacts of its pile.
  tick.contacts.for_each_pair([&](const ContactKey& key) { f(key.body_a, key.body_b); });
}

}  // namespace

/// Sets the numbers of bodies from those that pairs ask for.
void TickParts::spread(const Tick& tick, std::span<const int> asked) {
  const std::span<const RigidBody> bodies = tick.bodies;
  DisjointSets sets(bodies.size());
  for_neighbours(tick, [&](uint32_t a, uint32_t b) {
    if (bodies[a].dynamic() && bodies[b].dynamic()) sets.join(a, b);
  });
  of_.assign(bodies.size(), 0);
  for (const uint32_t i : tick.active) {
    int& number = of_[bodies[i].dynamic() ? sets.root(i) : i];
    number = std::max(number, 1);
  }
  for (size_t k = 0; k < asked.size(); ++k) {
    const ProxyPair& pair = tick.pairs[k];
    const uint32_t a = tick.proxies.refs[pair.a].body, b = tick.proxies.refs[pair.b].body;
    if (!bodies[a].dynamic() && !bodies[b].dynamic()) continue;
    // Sleeping bodies in pairs have a number too, since a moving body may wake them.
    int& number = of_[sets.root(bodies[a].dynamic() ? a : b)];
    number = std::max(number, asked[k]);
  }
  for (uint32_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].dynamic()) of_[i] = of_[sets.root(i)];
  // Kinematic bodies connect nothing; each gets the greatest number of its dynamic neighbours.
  for_neighbours(tick, [&](uint32_t a, uint32_t b) {
    for (const auto& [body, other] : {std::pair(a, b), std::pair(b, a)})
      if (!bodies[body].dynamic() && bodies[other].dynamic() && is_active(bodies[body]))
        of_[body] = std::max(of_[body], of_[other]);
  });
}

void TickParts::find(const Tick& tick, const RealtimeSettings& settings) {
  numbers_.clear();
  of_.clear();
  if (!tick.proxies.may_need_parts && !tick.close) return;
  std::vector<int> asked;
  for (const ProxyPair& pair : tick.pairs)
    asked.push_back(parts_for(tick, pair, settings.max_parts));
  if (std::ranges::all_of(asked, [](int n) { return n == 1; })) return;
  spread(tick, asked);
  numbers_.clear();
  std::ranges::copy_if(of_, std::back_inserter(numbers_), [](int n) { return n > 0; });
  std::ranges::sort(numbers_);
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
}

void TickParts::take_in(std::span<const uint32_t> active, int number) {
  for (const uint32_t i : active)
    if (of_[i] == 0) of_[i] = number;
}

RealtimeSettings part_settings(const RealtimeSettings& settings, int parts) {
  RealtimeSettings part = settings;
  part.substeps = (settings.substeps + parts - 1) / parts;
  part.max_substeps = (settings.max_substeps + parts - 1) / parts;
  return part;
}

}  // namespace tumble
