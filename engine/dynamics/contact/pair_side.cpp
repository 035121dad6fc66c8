#include "engine/dynamics/contact/pair_side.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/bodies/point_mass.hpp"

#include <algorithm>
#include <limits>

namespace tumble {

PairSide pair_side(std::span<const RigidBody> bodies, ShapeRef ref, const Vec3& gravity, double h,
                   double margin) {
  const RigidBody& body = bodies[ref.body];
  const BodyShape& of_body = body.shapes[ref.shape];
  PairSide side;
  side.shape_pose = body.pose * of_body.pose;
  side.body_pose = body.pose;
  side.end_velocity = body.v;
  side.foresight = std::numeric_limits<double>::infinity();
  side.margin = contact_margin(body, margin);
  side.radius = body.bounding_radius;
  side.shape_radius = of_body.shape->bounding_radius();
  side.shape = of_body.shape.get();
  side.body = ref.body;
  side.shape_index = ref.shape;
  side.dynamic = body.dynamic();
  side.polyhedral = side.shape->polyhedral() != nullptr;
  side.planes = side.polyhedral || side.shape->is_half_space();
  side.mesh = side.shape->is_mesh();
  side.sphere = side.shape->is_ball();
  side.particle = is_particle(body);
  side.friction = of_body.material.friction;
  side.restitution = of_body.material.restitution;
  if (!side.particle) {
    side.rolling_friction = of_body.material.rolling_arm();
    side.torsional_friction = of_body.material.torsional_arm();
  }
  if (!of_body.material.surface_velocity.isZero(0))
    side.belt = body.pose.direction(of_body.material.surface_velocity);
  if (side.dynamic) {
    side.end_velocity += h * body.gravity_scale * gravity;
    const ShapeTurning turning = shape_turning(body, of_body, h);
    side.end_velocity += turning.velocity;
    side.turning = turning.reach;
    if (!body.looks_far) side.foresight = foresight(body);
  }
  return side;
}

}  // namespace tumble
