#include "engine/dynamics/event/event_contact_list.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

ContactPoint point_of(const EventContact& c, const ElementGap& g,
                      std::span<const RigidBody> bodies) {
  ContactPoint p;
  p.anchor_a = bodies[c.key.body_a].pose.inverse_point(g.x_world - 0.5 * g.gap * g.normal);
  p.anchor_b = bodies[c.key.body_b].pose.inverse_point(g.x_world + 0.5 * g.gap * g.normal);
  p.gap = g.gap;
  p.feature = c.feature;
  p.normal_force = std::max(0.0, c.force.dot(g.normal));
  p.friction_force = c.force - c.force.dot(g.normal) * g.normal;
  p.normal_impulse = std::max(0.0, c.impulse.dot(g.normal));
  p.friction_impulse = c.impulse - c.impulse.dot(g.normal) * g.normal;
  return p;
}

}  // namespace

std::vector<Contact> contact_list(std::span<const EventContact> contacts,
                                  std::span<const RigidBody> bodies) {
  std::vector<Contact> out;
  for (const EventContact& c : contacts) {
    const ElementGap g = gap_now(c, bodies);
    if (!c.closed && c.impulse.isZero(0) && c.room(g) > tolerances::touch_distance) continue;
    if (out.empty() || out.back().key != c.key || out.back().count == 4) {
      Contact& made = out.emplace_back();
      made.key = c.key;
      made.normal = g.normal;
      made.friction = c.friction;
      made.restitution = c.restitution;
      made.surface_velocity = c.surface_velocity;
    }
    Contact& to = out.back();
    to.points[size_t(to.count++)] = point_of(c, g, bodies);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Contact& a, const Contact& b) { return a.key < b.key; });
  return out;
}

}  // namespace tumble
