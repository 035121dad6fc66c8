#include "engine/dynamics/forces/drag.hpp"

#include "engine/dynamics/forces/pulled.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

void apply(const LinearDragDef& def, ForceContext& context) {
  const double h = context.h;
  const auto mean_rate = [&](double rate) {
    return context.momentary ? rate : (1 - det::exp(-rate * h)) / h;
  };
  const double f = mean_rate(def.rate), t = mean_rate(def.angular_rate);
  for_each_pulled(context, [&](RigidBody& b) {
    b.force -= b.mass * f * b.v;
    b.torque -= t * (b.inertia_world() * b.omega);
  });
  for (ParticleSystem& p : pulled_particles(context))
    for (size_t i = 0; i < p.size(); ++i) p.force[i] -= p.mass[i] * f * p.v[i];
}

void apply(const QuadraticDragDef& def, ForceContext& context) {
  // At one moment there is no step that could overshoot.
  const double h = context.momentary ? 0 : context.h;
  const double half = 0.5 * def.fluid_density * def.coefficient;
  const Vec3 wind = def.wind.now();
  // du/dt = -k |u| u has the solution u(h) = u / (1 + k |u| h).
  const auto drag = [&](const Vec3& v, double area, double mass) -> Vec3 {
    const Vec3 u = v - wind;
    const double k = half * area / mass, speed = u.norm();
    return -mass * k * speed / (1 + k * speed * h) * u;
  };
  for_each_pulled(context, [&](RigidBody& b) {
    const double r = b.bounding_radius;
    if (!std::isfinite(r)) return;
    b.force += drag(b.v, det::pi * r * r, b.mass);
    const double damping = half * r * r * r * r * r * b.omega.norm();
    if (!(damping > 0)) return;
    // As above about each principal axis: d omega = -(I + h c)^-1 h c omega takes energy away
    // whatever the moments are.
    Vec3 omega = b.omega;
    if (h > 0) {
      const Mat3 inertia = b.inertia_world();
      omega = (inertia + h * damping * Mat3::Identity()).inverse() * (inertia * b.omega);
    }
    b.torque -= damping * omega;
  });
  for (ParticleSystem& p : pulled_particles(context))
    for (size_t i = 0; i < p.size(); ++i)
      p.force[i] += drag(p.v[i], det::pi * p.radius[i] * p.radius[i], p.mass[i]);
}

}  // namespace tumble
