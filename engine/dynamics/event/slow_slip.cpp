#include "engine/dynamics/event/slow_slip.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Of a point in all directions together, an upper bound of that in any [1/kg].
double compliance(const RigidBody& body, const Vec3& x) {
  if (!body.dynamic()) return 0;
  const Vec3 arm = x - body.pose.x;
  const Mat3 inverse = body.inverse_inertia_world();
  double sum = body.inverse_mass;
  for (int k = 0; k < 3; ++k) {
    const Vec3 turn = arm.cross(Vec3::Unit(k));
    sum += turn.dot(inverse * turn);
  }
  return sum;
}

/// A contact that is new has no force yet: that it carries a whole body is more than enough.
double load(const EventContact& c, std::span<const RigidBody> bodies) {
  double force = c.force.norm();
  if (force > 0) return force;
  for (const uint32_t slot : {c.key.body_a, c.key.body_b})
    if (bodies[slot].dynamic()) force = std::max(force, bodies[slot].force.norm());
  return force;
}

}  // namespace

SlipForesight slip_foresight(const EventContact& c, std::span<const RigidBody> bodies, double h) {
  if (!c.closed || !c.sliding) return {};
  const ElementGap g = push_gap(c, bodies);
  const double w =
      compliance(bodies[c.key.body_a], g.x_world) + compliance(bodies[c.key.body_b], g.x_world);
  const double braking = c.friction * load(c, bodies) * w;
  const double rate = braking / slip_of(c, g, bodies).norm();
  return {rate * h > tolerances::stiff_rate ? h - tolerances::stiff_rate / rate : 0, braking};
}

}  // namespace tumble
