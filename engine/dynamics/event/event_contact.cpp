#include "engine/dynamics/event/event_contact.hpp"

#include "engine/collision/query.hpp"
#include "engine/dynamics/event/contact_elements.hpp"
#include "engine/dynamics/event/tolerances.hpp"

namespace tumble {
namespace {

/// The one that is a particle, if exactly one is.
const RigidBody* particle_of(const EventContact& c, std::span<const RigidBody> bodies) {
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  const bool of_a = is_particle(a), of_b = is_particle(b);
  return of_a == of_b ? nullptr : of_a ? &a : &b;
}

}  // namespace

bool same_shapes(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

BodyMotion motion_of(const RigidBody& body) {
  return {body.pose, body.v, body.omega};
}

void put_motion(const BodyMotion& motion, RigidBody& body) {
  body.pose = motion.pose;
  body.v = motion.v;
  body.omega = motion.omega;
}

ElementGap gap_now(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementGap g = element_gap(c.a, motion_of(bodies[c.key.body_a]), c.b,
                             motion_of(bodies[c.key.body_b]), c.towards_b);
  if (!g.regular) g.gap = tolerances::no_limit;
  return g;
}

ElementPlace place_now(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementPlace g = element_place(c.a, motion_of(bodies[c.key.body_a]), c.b,
                                 motion_of(bodies[c.key.body_b]), c.towards_b);
  if (!g.regular) g.gap = tolerances::no_limit;
  return g;
}

ElementPlace push_place(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementPlace g = place_now(c, bodies);
  if (const RigidBody* particle = particle_of(c, bodies); particle && g.regular)
    g.x_world = particle->pose.x;
  return g;
}

ElementGap push_gap(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementGap g = gap_now(c, bodies);
  const RigidBody* particle = particle_of(c, bodies);
  if (!particle || !g.regular) return g;
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  g.x_world = particle->pose.x;
  const Vec3 change =
      particle == &b ? Vec3(-a.omega.cross(b.v - a.v)) : Vec3(b.omega.cross(a.v - b.v));
  g.tangential_bias = change - g.normal.dot(change) * g.normal;
  return g;
}

double free_acceleration(const EventContact& c, const ElementGap& g,
                         std::span<const RigidBody> bodies) {
  const auto at_point = [&](uint32_t slot) -> Vec3 {
    const RigidBody& b = bodies[slot];
    if (!b.dynamic()) return Vec3::Zero();
    const Vec3 gyroscopic = b.omega.cross(b.inertia_world() * b.omega);
    const Vec3 turn = b.inverse_inertia_world() * (b.torque - gyroscopic);
    return b.inverse_mass * b.force + turn.cross(g.x_world - b.pose.x);
  };
  return g.normal.dot(at_point(c.key.body_b) - at_point(c.key.body_a)) + g.bias;
}

std::optional<Vec3> crossing_of(const EventContact& c, std::span<const RigidBody> bodies) {
  if (!is_straight(c.a) || !is_straight(c.b)) return {};
  return place_now(c, bodies).x_world;
}

bool ran_away(const EventContact& c, const Vec3& from, std::span<const RigidBody> bodies) {
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  const BodyShape &sa = a.shapes[c.key.shape_a], &sb = b.shapes[c.key.shape_b];
  const double size = std::min(sa.shape->bounding_radius(), sb.shape->bounding_radius());
  const Vec3 x = place_now(c, bodies).x_world;
  return (x - from).norm() > tolerances::far_along_of_size * size ||
         !closest_point(*sa.shape, a.pose * sa.pose, x, tolerances::far_off_of_size * size) ||
         !closest_point(*sb.shape, b.pose * sb.pose, x, tolerances::far_off_of_size * size);
}

Vec3 slip_of(const EventContact& c, const ElementPlace& g, std::span<const RigidBody> bodies) {
  const Vec3 u = bodies[c.key.body_b].velocity_at(g.x_world) -
                 bodies[c.key.body_a].velocity_at(g.x_world) - c.surface_velocity;
  return u - g.normal.dot(u) * g.normal;
}

}  // namespace tumble
