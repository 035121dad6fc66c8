#pragma once
#include "engine/core/parameters.hpp"
#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/forces/force_context.hpp"
#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/varying.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// What a field acts on: the bodies and particle systems that are listed; everything when neither
/// list has an entry. What no longer exists is passed over.
struct FieldTargets {
  std::vector<BodyId> bodies;
  std::vector<ParticleSystemId> particles;
  bool everything() const { return bodies.empty() && particles.empty(); }
};

/// A field of acceleration with a potential: `acceleration(x)` [m/s2] and `potential(x)` [J/kg],
/// acceleration = -grad potential. Bodies feel it at their centre of mass.
template <class T>
concept PotentialField = requires(const T& f, const Vec3& x) {
  f.targets;
  f.acceleration(x);
  f.potential(x);
};

/// A field of velocity of a fluid that carries things along: `at(t)` gives the flow of a moment,
/// callable with a point [m], in m/s; `grip` says how strongly.
template <class T>
concept FlowField = requires(const T& f, double t, const Vec3& x) {
  f.targets;
  f.grip;
  f.at(t)(x);
};

/// How a flow takes things along: F = m (c + k |w|) w with w the velocity of the fluid relative to
/// the thing, c the `rate`, and k = 1/2 rho Cd A / m for the area A of the disc of the bounding
/// radius (particles: their radius). Over a tick the impulse is that of dw/dt = -(c + k |w|) w, so
/// that it never overshoots. Bodies turn with what the fluid turns over their own radius, at the
/// same rate c, and with the torque of quadratic_drag.
struct FlowGrip {
  double rate = 1;            ///< c [1/s]
  double fluid_density = 0;   ///< rho [kg/m3]
  double coefficient = 0.47;  ///< Cd [-]

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.rate, {.name = "rate",
                     .unit = "1/s",
                     .min = 0,
                     .doc = "linear drag: decay rate of the velocity relative to the flow"});
    v.field(d.fluid_density, {.name = "fluid_density",
                              .unit = "kg/m3",
                              .min = 0,
                              .doc = "quadratic drag: density of the fluid"});
    v.field(d.coefficient, {.name = "coefficient", .min = 0, .doc = "quadratic drag: coefficient"});
  }
};

/// What FlowGrip gives over a tick of h seconds (0: of the moment): acceleration of something that
/// has the velocity `w` relative to the flow; `rate` and `k` as there.
Vec3 flow_acceleration(const Vec3& w, double rate, double k, double h);

/// Calls `body(RigidBody&)` for the dynamic bodies and `particles(ParticleSystem&)` for the systems
/// that a field acts on; with ForceContext::only those bodies, and blocks of particles, alone.
template <class Body, class Particles>
void for_targets(const FieldTargets& targets, const ForceContext& context, Body body,
                 Particles particles) {
  std::vector<RigidBody>& all = context.bodies.bodies;
  if (targets.everything() && context.only_some()) {
    for (const uint32_t slot : context.only)
      if (all[slot].dynamic()) body(all[slot]);
  } else if (targets.everything()) {
    for (RigidBody& b : all)
      if (b.dynamic()) body(b);
    for (ParticleSystem& p : context.particles) particles(p);
  } else {
    for (const BodyId id : targets.bodies) {
      RigidBody* b = context.bodies.find(id);
      if (b && b->dynamic() && context.may_pull(id.index)) body(*b);
    }
    for (const ParticleSystemId id : targets.particles) {
      if (!context.particle_ids.contains(id)) continue;
      if (!context.only_some()) {
        particles(context.particles[id.index]);
      } else {
        for (const uint32_t slot : context.asked_blocks(id.index)) body(all[slot]);
      }
    }
  }
}

template <PotentialField Def>
void apply(const Def& def, ForceContext& context) {
  const double lead = context.momentary ? 0 : context.lead;
  for_targets(
      def.targets, context,
      [&](RigidBody& b) {
        if (!b.asleep) b.force += b.mass * def.acceleration(b.pose.x + lead * b.v);
      },
      [&](ParticleSystem& p) {
        for (size_t i = 0; i < p.size(); ++i)
          p.force[i] += p.mass[i] * def.acceleration(p.x[i] + lead * p.v[i]);
      });
}

template <PotentialField Def>
double potential_energy(const Def& def, const ForceContext& context) {
  double sum = 0;
  for_targets(
      def.targets, context, [&](RigidBody& b) { sum += b.mass * def.potential(b.pose.x); },
      [&](ParticleSystem& p) {
        for (size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * def.potential(p.x[i]);
      });
  return sum;
}

/// Half the curl of a flow over a distance r: what a ball of that radius turns with [rad/s].
template <class Flow>
Vec3 flow_spin(const Flow& flow, const Vec3& x, double r) {
  Mat3 gradient;  // column j: du/dx_j
  for (int j = 0; j < 3; ++j) {
    const Vec3 step = r * Vec3::Unit(j);
    gradient.col(j) = (flow(x + step) - flow(x - step)) / (2 * r);
  }
  return 0.5 * Vec3(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
                    gradient(1, 0) - gradient(0, 1));
}

/// Force and torque of a flow on one body; on what cannot turn the force alone.
template <class Flow>
void carry_along(const Flow& flow, const FlowGrip& grip, const ForceContext& context,
                 RigidBody& b) {
  const double r = b.bounding_radius;
  if (b.asleep || !(r > 0 && r < tolerances::endless_body)) return;
  constexpr double pi = 3.14159265358979323846;
  const double half = 0.5 * grip.fluid_density * grip.coefficient;
  const double lead = context.momentary ? 0 : context.lead, h = context.momentary ? 0 : context.h;
  // The velocity in the middle of the tick, as far as gravity changes it.
  const Vec3 v = b.v + lead * b.gravity_scale * context.gravity;
  const Vec3 x = b.pose.x + lead * b.v;
  b.force += b.mass * flow_acceleration(flow(x) - v, grip.rate, half * pi * r * r / b.mass, h);
  if (is_particle(b)) return;
  const Vec3 turn = flow_spin(flow, x, r) - b.omega;
  const double spin2 = turn.squaredNorm();
  if (!(spin2 > 0)) return;
  const Mat3 inertia = b.inertia_world();
  const double about = turn.dot(inertia * turn) / spin2;
  if (!(about > 0)) return;
  b.torque += inertia * flow_acceleration(turn, grip.rate, half * r * r * r * r * r / about, h);
}

template <FlowField Def>
void apply(const Def& def, ForceContext& context) {
  const auto flow = def.at(context.momentary ? context.t : context.t + context.lead);
  const FlowGrip& grip = def.grip;
  constexpr double pi = 3.14159265358979323846;
  const double half = 0.5 * grip.fluid_density * grip.coefficient;
  for_targets(
      def.targets, context, [&](RigidBody& b) { carry_along(flow, grip, context, b); },
      [&](ParticleSystem& p) {
        const Vec3 fall = context.lead * p.gravity_scale * context.gravity;
        for (size_t i = 0; i < p.size(); ++i) {
          const double area = pi * p.radius[i] * p.radius[i];
          const Vec3 w = flow(p.x[i] + context.lead * p.v[i]) - (p.v[i] + fall);
          p.force[i] +=
              p.mass[i] * flow_acceleration(w, grip.rate, half * area / p.mass[i], context.h);
        }
      });
}

}  // namespace tumble
