#include "engine/scene/build/describe_body.hpp"

#include <string>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Sets `value` to `now` if that differs from `before` and is given.
template <class T, class U>
void take_over(const T& before, const T& now, U& value) {
  if (before != now) value = U(now);
}
template <class T, class U>
void take_over(const std::optional<T>& before, const std::optional<T>& now, U& value) {
  if (now && before != now) value = U(*now);
}

/// The double with the shortest decimal form of a float: 0.6 for 0.6f.
double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

bool same_colour(const std::optional<Colour>& a, const std::optional<Colour>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->r == b->r && a->g == b->g && a->b == b->b;
}

}  // namespace

BodyDescription describe_body(const BodyDef& def) {
  BodyDescription d;
  d.type = def.type;
  d.placement.position = def.pose.x;
  d.placement.euler_deg = quat_to_euler_deg(def.pose.q);
  d.velocity = def.velocity;
  d.angular_velocity = def.angular_velocity;
  d.mass = def.mass;
  d.inertia = def.inertia;
  d.products = def.products;
  d.centre = def.centre;
  d.colour = Colour::from_linear(def.look.colour);
  d.look.roughness = shortest(def.look.roughness);
  d.look.metallic = shortest(def.look.metallic);
  d.look.pattern = shortest(def.look.pattern);
  d.look.opacity = shortest(def.look.opacity);
  d.look.visible = def.look.visible;
  d.group = int(def.group);
  d.gravity_scale = def.gravity_scale;
  d.fluid_friction = def.fluid_friction;
  d.can_sleep = def.can_sleep;
  d.precise = def.precise;
  d.starts_asleep = def.starts_asleep;
  d.hull_mass = def.hull_mass;
  return d;
}

MaterialDescription describe_material(const Material& m) {
  MaterialDescription d;
  d.friction = m.friction;
  d.restitution = m.restitution;
  d.density = m.density;
  d.surface_velocity = m.surface_velocity;
  d.rolling_friction = m.rolling_friction;
  d.torsional_friction = m.torsional_friction;
  return d;
}

void apply_changes(const BodyDescription& before, const BodyDescription& after, BodyDef& def) {
  take_over(before.type, after.type, def.type);
  take_over(before.placement.position, after.placement.position, def.pose.x);
  if (before.placement.euler_deg != after.placement.euler_deg && after.placement.euler_deg)
    def.pose.q = euler_deg_to_quat(*after.placement.euler_deg);
  take_over(before.velocity, after.velocity, def.velocity);
  take_over(before.angular_velocity, after.angular_velocity, def.angular_velocity);
  if (before.mass != after.mass) def.mass = after.mass;
  if (before.inertia != after.inertia) def.inertia = after.inertia;
  if (before.products != after.products) def.products = after.products;
  if (before.centre != after.centre) def.centre = after.centre;
  if (!same_colour(before.colour, after.colour) && after.colour)
    def.look.colour = after.colour->linear();
  take_over(before.look.roughness, after.look.roughness, def.look.roughness);
  take_over(before.look.metallic, after.look.metallic, def.look.metallic);
  take_over(before.look.pattern, after.look.pattern, def.look.pattern);
  take_over(before.look.opacity, after.look.opacity, def.look.opacity);
  take_over(before.look.visible, after.look.visible, def.look.visible);
  take_over(before.group, after.group, def.group);
  take_over(before.gravity_scale, after.gravity_scale, def.gravity_scale);
  take_over(before.fluid_friction, after.fluid_friction, def.fluid_friction);
  take_over(before.can_sleep, after.can_sleep, def.can_sleep);
  take_over(before.precise, after.precise, def.precise);
  take_over(before.hull_mass, after.hull_mass, def.hull_mass);
}

void apply_changes(const MaterialDescription& before, const MaterialDescription& after,
                   Material& material) {
  take_over(before.friction, after.friction, material.friction);
  take_over(before.restitution, after.restitution, material.restitution);
  take_over(before.density, after.density, material.density);
  take_over(before.surface_velocity, after.surface_velocity, material.surface_velocity);
  take_over(before.rolling_friction, after.rolling_friction, material.rolling_friction);
  take_over(before.torsional_friction, after.torsional_friction, material.torsional_friction);
}

}  // namespace tumble
