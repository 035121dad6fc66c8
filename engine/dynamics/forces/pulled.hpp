#pragma once
#include "engine/dynamics/forces/force_context.hpp"

namespace tumble {

/// Calls visit(RigidBody&) for every body that a force on everything acts on: awake dynamic ones;
/// with ForceContext::only those alone.
template <class Visit>
void for_each_pulled(ForceContext& context, Visit&& visit) {
  std::vector<RigidBody>& bodies = context.bodies.bodies;
  const auto pull = [&](RigidBody& b) {
    if (b.dynamic() && !b.asleep) visit(b);
  };
  if (context.only_some()) {
    for (const uint32_t slot : context.only) pull(bodies[slot]);
  } else {
    for (RigidBody& b : bodies) pull(b);
  }
}

/// The particles that a force acts on: none with ForceContext::only, where they are blocks among
/// the bodies or move once a tick.
inline std::span<ParticleSystem> pulled_particles(ForceContext& context) {
  if (context.only_some()) return {};
  return context.particles;
}

}  // namespace tumble
