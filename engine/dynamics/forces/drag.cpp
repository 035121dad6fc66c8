#include "engine/dynamics/forces/drag.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

void apply(const LinearDragDef& def, ForceContext& context) {
  const double h = context.h;
  const double f = (1 - det::exp(-def.rate * h)) / h;
  const double t = (1 - det::exp(-def.angular_rate * h)) / h;
  for (RigidBody& b : context.bodies.bodies) {
    if (!b.dynamic() || b.asleep) continue;
    b.force -= b.mass * f * b.v;
    b.torque -= t * (b.inertia_world() * b.omega);
  }
  for (ParticleSystem& p : context.particles)
    for (size_t i = 0; i < p.size(); ++i) p.force[i] -= p.mass[i] * f * p.v[i];
}

void apply(const QuadraticDragDef& def, ForceContext& context) {
  const double h = context.h;
  const double half = 0.5 * def.fluid_density * def.coefficient;
  // du/dt = -k |u| u has the solution u(h) = u / (1 + k |u| h).
  const auto drag = [&](const Vec3& v, double area, double mass) -> Vec3 {
    const Vec3 u = v - def.wind;
    const double k = half * area / mass, speed = u.norm();
    return -mass * k * speed / (1 + k * speed * h) * u;
  };
  for (RigidBody& b : context.bodies.bodies) {
    if (!b.dynamic() || b.asleep) continue;
    const double r = b.bounding_radius;
    if (!std::isfinite(r)) continue;
    b.force += drag(b.v, det::pi * r * r, b.mass);
    const double spin = b.omega.norm();
    if (spin > 0) {
      const double k = half * r * r * r * r * r;
      const double inertia = b.omega.dot(b.inertia_world() * b.omega) / (spin * spin);
      b.torque -= k * spin / (1 + k * spin * h / inertia) * b.omega;
    }
  }
  for (ParticleSystem& p : context.particles)
    for (size_t i = 0; i < p.size(); ++i)
      p.force[i] += drag(p.v[i], det::pi * p.radius[i] * p.radius[i], p.mass[i]);
}

}  // namespace tumble
