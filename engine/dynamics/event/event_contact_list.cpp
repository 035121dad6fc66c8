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

/// The key under which the realtime stepper stores the contact, which pairs some bodies as wholes.
ContactKey name_of_pair(const EventContact& c, std::span<const RigidBody> bodies) {
  const bool whole_a = bodies[c.key.body_a].tree != nullptr,
             whole_b = bodies[c.key.body_b].tree != nullptr;
  ContactKey key = c.key;
  if (whole_a || whole_b) key.part += mark_of({c.key.shape_a, c.key.shape_b});
  if (whole_a) key.shape_a = 0;
  if (whole_b) key.shape_b = 0;
  return key;
}

}  // namespace

std::vector<Contact> contact_list(std::span<const EventContact> contacts,
                                  std::span<const RigidBody> bodies) {
  std::vector<Contact> out;
  for (const EventContact& c : contacts) {
    const ElementGap g = gap_now(c, bodies);
    if (!c.closed && c.impulse.isZero(0) && c.room(g) > tolerances::touch_distance) continue;
    const ShapesOfPair shapes{c.key.shape_a, c.key.shape_b};
    const ContactKey key = name_of_pair(c, bodies);
    if (out.empty() || out.back().key != key || out.back().shapes != shapes ||
        out.back().count == 4) {
      Contact& made = out.emplace_back();
      made.key = key;
      made.shapes = shapes;
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
