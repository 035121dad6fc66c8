#include "engine/dynamics/event/slow_slip.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Trace of the compliance at a point: an upper bound of that in any direction [1/kg].
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

}  // namespace

double load_of(const EventContact& c, std::span<const RigidBody> bodies) {
  double force = c.force.norm();
  if (force > 0) return force;
  for (const uint32_t slot : {c.key.body_a, c.key.body_b})
    if (bodies[slot].dynamic()) force = std::max(force, bodies[slot].force.norm());
  return force;
}

SlipForesight slip_foresight(double braking, double speed, double h) {
  const double rate = braking / speed;
  return {rate * h > tolerances::stiff_rate ? h - tolerances::stiff_rate / rate : 0, braking};
}

SlipForesight slip_foresight(const EventContact& c, std::span<const RigidBody> bodies, double h) {
  if (!c.closed || !c.sliding) return {};
  const ElementGap g = push_gap(c, bodies);
  const double w =
      compliance(bodies[c.key.body_a], g.x_world) + compliance(bodies[c.key.body_b], g.x_world);
  return slip_foresight(c.friction * load_of(c, bodies) * w, slip_of(c, g, bodies).norm(), h);
}

}  // namespace tumble
