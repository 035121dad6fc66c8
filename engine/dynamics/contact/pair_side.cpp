#include "engine/dynamics/contact/pair_side.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/bodies/whole_body.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

SideSurface surface_on(const RigidBody& body, const Material& material, bool particle) {
  SideSurface s;
  s.friction = material.friction;
  s.restitution = material.restitution;
  if (!particle) {
    s.rolling_friction = material.rolling_arm();
    s.torsional_friction = material.torsional_arm();
  }
  if (!material.surface_velocity.isZero(0)) s.belt = body.pose.direction(material.surface_velocity);
  return s;
}

/// What all sides of a body have in common.
PairSide side_of(const RigidBody& body, uint32_t slot, const SideTick& tick) {
  PairSide side;
  side.body_pose = body.pose;
  side.end_velocity = body.v;
  side.foresight = std::numeric_limits<double>::infinity();
  side.margin = contact_margin(body, tick.margin);
  side.radius = body.bounding_radius;
  side.body = slot;
  side.dynamic = body.dynamic();
  side.particle = is_particle(body);
  if (side.dynamic) {
    side.end_velocity += tick.h * body.gravity_scale * tick.gravity;
    side.foresight = foresight(body);
  }
  return side;
}

}  // namespace

bool made_of_planes(const Shape& shape) {
  return shape.polyhedral() != nullptr || shape.is_half_space();
}

SideSurface PairSide::surface_of(uint32_t shape_index) const {
  return several ? surface_on(*several, several->shapes[shape_index].material, particle) : surface;
}

PairSide shape_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick) {
  const RigidBody& body = bodies[ref.body];
  const BodyShape& of_body = body.shapes[ref.shape];
  PairSide side = side_of(body, ref.body, tick);
  side.shape_pose = body.pose * of_body.pose;
  side.shape_radius = of_body.shape->bounding_radius();
  side.shape = of_body.shape.get();
  side.polyhedral = side.shape->polyhedral() != nullptr;
  side.planes = made_of_planes(*side.shape);
  side.mesh = side.shape->is_mesh();
  side.sphere = side.shape->is_ball();
  side.surface = surface_on(body, of_body.material, side.particle);
  if (side.dynamic) {
    const ShapeTurning turning = shape_turning(body, of_body, tick.h);
    side.end_velocity += turning.velocity;
    side.turning = turning.reach;
  }
  return side;
}

PairSide body_side(std::span<const RigidBody> bodies, uint32_t slot, const SideTick& tick) {
  const RigidBody& body = bodies[slot];
  if (body.shapes.size() == 1) return shape_side(bodies, {slot, 0}, tick);
  PairSide side = side_of(body, slot, tick);
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

}  // namespace tumble
