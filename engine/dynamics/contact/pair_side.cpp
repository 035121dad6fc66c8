#include "engine/dynamics/contact/pair_side.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/bodies/whole_body.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

void take_surface(SideSurface& s, const RigidBody& body, const Material& material, bool particle) {
  s.friction = material.friction;
  s.restitution = material.restitution;
  if (!particle) {
    s.rolling_friction = material.rolling_arm();
    s.torsional_friction = material.torsional_arm();
  }
  if (!material.surface_velocity.isZero(0)) s.belt = body.pose.direction(material.surface_velocity);
}

/// Sets what all sides of a body have in common.
void take_body(PairSide& side, const RigidBody& body, ShapeRef ref, const SideTick& tick) {
  side.body_pose = body.pose;
  side.end_velocity = body.v;
  side.foresight = std::numeric_limits<double>::infinity();
  side.margin = contact_margin(body, tick.margin);
  side.radius = body.bounding_radius;
  side.body = ref.body;
  side.shape_index = ref.shape;
  side.dynamic = body.dynamic();
  side.particle = is_particle(body);
  if (side.dynamic) {
    side.end_velocity += tick.h * body.gravity_scale * tick.gravity;
    if (!body.looks_far) side.foresight = foresight(body);
  }
}

PairSide whole_side(const RigidBody& body, uint32_t slot, const SideTick& tick) {
  PairSide side;
  take_body(side, body, {slot, 0}, tick);
  side.shape_pose = body.pose;
  side.shape_radius = body.bounding_radius;
  side.several = &body;
  const auto all = [&body](const auto& property) {
    return std::ranges::all_of(body.shapes, [&](const BodyShape& s) { return property(*s.shape); });
  };
  side.polyhedral = all([](const Shape& s) { return s.polyhedral() != nullptr; });
  side.planes = side.polyhedral || all(&made_of_planes);
  side.mesh = side.polyhedral && all([](const Shape& s) { return s.is_mesh(); });
  if (side.dynamic) side.turning = whole_turning(body, tick.h);
  return side;
}

}  // namespace

bool made_of_planes(const Shape& shape) {
  return shape.polyhedral() != nullptr || shape.is_half_space();
}

SideSurface PairSide::surface_of(uint32_t shape) const {
  if (!several) return *this;
  SideSurface s;
  take_surface(s, *several, several->shapes[shape].material, particle);
  return s;
}

PairSide shape_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick) {
  const RigidBody& body = bodies[ref.body];
  const BodyShape& of_body = body.shapes[ref.shape];
  PairSide side;
  take_body(side, body, ref, tick);
  side.shape_pose = body.pose * of_body.pose;
  side.shape_radius = of_body.shape->bounding_radius();
  side.shape = of_body.shape.get();
  side.polyhedral = side.shape->polyhedral() != nullptr;
  side.planes = made_of_planes(*side.shape);
  side.mesh = side.shape->is_mesh();
  side.sphere = side.shape->is_ball();
  take_surface(side, body, of_body.material, side.particle);
  if (side.dynamic) {
    const ShapeTurning turning = shape_turning(body, of_body, tick.h);
    side.end_velocity += turning.velocity;
    side.turning = turning.reach;
  }
  return side;
}

PairSide pair_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick) {
  const RigidBody& body = bodies[ref.body];
  return body.tree ? whole_side(body, ref.body, tick) : shape_side(bodies, ref, tick);
}

}  // namespace tumble
