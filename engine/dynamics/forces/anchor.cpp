#include "engine/dynamics/forces/anchor.hpp"

#include "engine/math/rotation.hpp"

namespace tumble {

RigidBody* pulled_body(const Anchor& anchor, const ForceContext& context) {
  if (anchor.kind == Anchor::Kind::body) return context.bodies.find(anchor.body);
  const uint32_t system = anchor.particles.index;
  if (anchor.kind != Anchor::Kind::particle || system >= context.particle_slots.size() ||
      context.particle_slots[system] == ~uint32_t{0} ||
      !context.particle_ids.contains(anchor.particles))
    return nullptr;
  const size_t i = context.particles[system].find(anchor.particle);
  if (i == context.particles[system].size()) return nullptr;
  return &context.bodies.bodies[context.particle_slots[system] + i];
}

std::optional<AnchorState> locate(const Anchor& anchor, const ForceContext& context) {
  switch (anchor.kind) {
    case Anchor::Kind::world:
      return AnchorState{anchor.point, Vec3::Zero()};
    case Anchor::Kind::body: {
      const RigidBody* b = context.bodies.find(anchor.body);
      if (!b) return std::nullopt;
      const Vec3 x = b->pose.point(anchor.point - b->centre_body);
      return AnchorState{x, b->velocity_at(x)};
    }
    case Anchor::Kind::particle: {
      if (const RigidBody* b = pulled_body(anchor, context)) return AnchorState{b->pose.x, b->v};
      if (!context.particle_ids.contains(anchor.particles)) return std::nullopt;
      const ParticleSystem& p = context.particles[anchor.particles.index];
      const size_t i = p.find(anchor.particle);
      if (i == p.size()) return std::nullopt;
      return AnchorState{p.x[i], p.v[i]};
    }
  }
  return std::nullopt;
}

Mat3 mobility(const Anchor& anchor, const ForceContext& context) {
  if (anchor.kind == Anchor::Kind::body) {
    const RigidBody* b = context.bodies.find(anchor.body);
    if (!b || !b->dynamic()) return Mat3::Zero();
    const Mat3 r = skew(b->pose.direction(anchor.point - b->centre_body));
    return Mat3::Identity() * b->inverse_mass - r * b->inverse_inertia_world() * r;
  }
  if (anchor.kind == Anchor::Kind::particle && context.particle_ids.contains(anchor.particles)) {
    const ParticleSystem& p = context.particles[anchor.particles.index];
    const size_t i = p.find(anchor.particle);
    if (i < p.size()) return Mat3::Identity() / p.mass[i];
  }
  return Mat3::Zero();
}

void add_force(const Anchor& anchor, const Vec3& force, ForceContext& context) {
  if (anchor.kind == Anchor::Kind::body) {
    RigidBody* b = context.bodies.find(anchor.body);
    if (!b || !b->dynamic()) return;
    b->force += force;
    b->torque += b->pose.direction(anchor.point - b->centre_body).cross(force);
  } else if (RigidBody* block = pulled_body(anchor, context)) {
    block->force += force;
  } else if (anchor.kind == Anchor::Kind::particle && !context.momentary &&
             context.particle_ids.contains(anchor.particles)) {
    ParticleSystem& p = context.particles[anchor.particles.index];
    const size_t i = p.find(anchor.particle);
    if (i < p.size()) p.force[i] += force;
  }
}

double lead_of(const Anchor& anchor, const ForceContext& context) {
  return anchor.kind == Anchor::Kind::world || context.momentary ? 0 : context.lead;
}

}  // namespace tumble
