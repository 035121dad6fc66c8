#include "engine/world/dragged_bodies.hpp"

#include "engine/world/tick_common.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

double least_thickness(const RigidBody& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const BodyShape& s : b.shapes) least = std::min(least, s.shape->least_thickness());
  return least;
}

/// A body that is deep inside a fixed one.
struct Sunk {
  uint32_t body = no_body, in = no_body;
  double depth = 0;  ///< [m]
};

Sunk deepest(const WorldState& s) {
  const std::vector<RigidBody>& bodies = s.bodies.bodies;
  Sunk worst;
  s.contacts.for_each([&](const Contact& c) {
    const bool a_moves = bodies[c.key.body_a].dynamic(), b_moves = bodies[c.key.body_b].dynamic();
    if (a_moves == b_moves) return;
    const uint32_t body = a_moves ? c.key.body_a : c.key.body_b;
    const uint32_t other = a_moves ? c.key.body_b : c.key.body_a;
    if (bodies[other].type != BodyType::fixed) return;
    for (const ContactPoint& p : c.used())
      if (-p.gap > worst.depth &&
          -p.gap > tolerances::dragged_depth * least_thickness(bodies[body]))
        worst = {body, other, -p.gap};
  });
  return worst;
}

/// A moving kinematic body that touches an island, or is connected to it by a joint.
uint32_t mover_of(const WorldState& s, uint32_t island) {
  const std::vector<RigidBody>& bodies = s.bodies.bodies;
  uint32_t mover = no_body;
  const auto look = [&](uint32_t slot, uint32_t other) {
    if (slot >= bodies.size() || other >= s.islands.island_of.size()) return;
    const RigidBody& b = bodies[slot];
    if (b.type == BodyType::kinematic && !(b.v.isZero(0) && b.omega.isZero(0)) &&
        s.islands.island_of[other] == island)
      mover = std::min(mover, slot);
  };
  for (const BodyLink& l : s.workspace.links) look(l.a, l.b), look(l.b, l.a);
  s.contacts.for_each([&](const Contact& c) {
    if (c.pressed()) look(c.key.body_a, c.key.body_b), look(c.key.body_b, c.key.body_a);
  });
  return mover;
}

}  // namespace

void warn_of_dragged_bodies(WorldState& s) {
  if (s.told.dragged || !(s.stats.max_penetration > tolerances::ordinary_overlap)) return;
  const Sunk sunk = deepest(s);
  if (sunk.body == no_body || sunk.body >= s.islands.island_of.size()) return;
  const uint32_t island = s.islands.island_of[sunk.body];
  const uint32_t mover = island > 0 ? mover_of(s, island) : no_body;
  if (mover == no_body) return;
  s.told.dragged = true;
  s.warn(fmt::format(
      "tick {}: {} is {:.3g} m inside of {}, which is fixed: {} is kinematic, goes its way "
      "whatever "
      "holds against it, and takes it along (let it move where there is room, or drive it by a "
      "spring; this is said once)",
      s.tick + 1, body_label(s, sunk.body), sunk.depth, body_label(s, sunk.in),
      body_label(s, mover)));
}

}  // namespace tumble
