#include "engine/dynamics/forces/mouse_spring.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>

namespace tumble {

namespace {

/// The spring per unit of effective mass: angular frequency and damping rate, bounded for the tick.
struct Tuning {
  double w;  ///< [rad/s]
  double c;  ///< [1/s]
};

Tuning tuning(const MouseSpringDef& def, double h) {
  const double w = 2 * det::pi * std::min(def.frequency, 0.4 / h);
  return {w, 2 * def.damping_ratio * w};
}

/// Bounds for the stages of an explicit integrator, which could not stand more over a tick: the
/// frequency is at most 0.1/h, the rate of damping 1.3/h.
Tuning momentary_tuning(const MouseSpringDef& def, double h) {
  Tuning t = tuning(def, 4 * h);
  t.c = std::min(t.c, 1.3 / h);
  return t;
}

/// Velocity of the held point after the tick, from v+ = v - h (w^2 (x + h v+ - target) + c v+).
Vec3 velocity_after(const Tuning& t, const Vec3& offset, const Vec3& v, double h) {
  return (v - h * t.w * t.w * offset) / (1 + h * t.c + h * h * t.w * t.w);
}

double weight_cap(const MouseSpringDef& def, double mass, const ForceContext& context) {
  const double g = context.gravity.norm();
  return def.max_weights * mass * (g > 0 ? g : 9.81);
}

Vec3 capped(const Vec3& force, double cap) {
  const double size = force.norm();
  return size > cap ? Vec3(force * (cap / size)) : force;
}

// With mass matrix M, torsional damping C (about the held point) and the point's Jacobian J the
// velocities u = (v, omega) after the tick satisfy M (u+ - u) = J^T p - h C omega+ and J u+ = v+
// above. Solving for the impulse p of the point takes every coupling implicitly, at any tick.
void pull_body(const MouseSpringDef& def, const AnchorState& at, RigidBody& body,
               ForceContext& context) {
  const double h = context.h;
  const Tuning t = tuning(def, h);
  const Vec3 r = at.x_world - body.pose.x;
  const Mat3 cross = skew(r);
  const Mat3 inertia = body.inertia_world();
  const double rate = 0.25 * def.damping_ratio * t.w;
  const Mat3 C = rate * (inertia - body.mass * cross * cross);
  const Mat3 angular = (inertia + h * C).inverse();
  const Vec3 omega_free = angular * (inertia * body.omega);
  const Mat3 K = Mat3::Identity() * body.inverse_mass - cross * angular * cross;
  const Vec3 fall = h * body.gravity_scale * context.gravity;
  const Vec3 wanted = velocity_after(t, at.x_world - def.target, at.v_world + fall, h);
  const Vec3 impulse = K.inverse() * (wanted - (body.v + fall + omega_free.cross(r)));
  const Vec3 force = capped(impulse / h, weight_cap(def, body.mass, context));
  body.force += force;
  const Vec3 turn = r.cross(force);
  const Vec3 omega_after = omega_free + angular * (h * turn);
  body.torque += turn - C * omega_after;
}

/// The same spring without a step: the held point's acceleration changes by -w^2 x - c v, whatever
/// else acts on it, by a force at it.
void pull_body_now(const MouseSpringDef& def, const AnchorState& at, RigidBody& body,
                   ForceContext& context) {
  const Tuning t = momentary_tuning(def, context.h);
  const Vec3 r = at.x_world - body.pose.x;
  const Mat3 cross = skew(r);
  const Mat3 inertia = body.inertia_world(), inverse_inertia = body.inverse_inertia_world();
  const double rate = 0.25 * def.damping_ratio * t.w;
  const Vec3 braking = -rate * ((inertia - body.mass * cross * cross) * body.omega);
  const Mat3 K = Mat3::Identity() * body.inverse_mass - cross * inverse_inertia * cross;
  const Vec3 wanted = -t.w * t.w * (at.x_world - def.target) - t.c * at.v_world;
  const Vec3 turning = (inverse_inertia * braking).cross(r);
  const Vec3 force = capped(K.inverse() * (wanted - turning), weight_cap(def, body.mass, context));
  body.force += force;
  body.torque += r.cross(force) + braking;
}

}  // namespace

void apply(const MouseSpringDef& def, ForceContext& context) {
  const auto at = locate(def.anchor, context);
  if (!at) return;
  if (def.anchor.kind == Anchor::Kind::body) {
    RigidBody* body = context.bodies.find(def.anchor.body);
    if (!body || !body->dynamic()) return;
    (context.momentary ? pull_body_now : pull_body)(def, *at, *body, context);
    return;
  }
  if (RigidBody* block = pulled_body(def.anchor, context); block && context.momentary) {
    pull_body_now(def, *at, *block, context);
    return;
  }
  const double mobility_trace = mobility(def.anchor, context).trace();
  if (!(mobility_trace > 0)) return;
  const double mass = 3 / mobility_trace, h = context.h;
  const ParticleSystem& p = context.particles[def.anchor.particles.index];
  const Vec3 v = at->v_world + h * p.gravity_scale * context.gravity;
  const Vec3 wanted = velocity_after(tuning(def, h), at->x_world - def.target, v, h);
  const Vec3 force = mass / h * (wanted - v);
  add_force(def.anchor, capped(force, weight_cap(def, mass, context)), context);
}

}  // namespace tumble
