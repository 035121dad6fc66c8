#include "engine/world/tick_forces.hpp"

#include <algorithm>

namespace tumble {
namespace {

bool holds_particles(const ForceDef& def) {
  const std::vector<Anchor> ends = anchors(def);
  return std::any_of(ends.begin(), ends.end(),
                     [](const Anchor& a) { return a.kind == Anchor::Kind::particle; });
}

}  // namespace

TickForces::TickForces(World::State& s) : state_(s), anchored_(s.bodies.bodies.size()) {
  for (RigidBody& b : s.bodies.bodies) {
    b.force.setZero();
    b.torque.setZero();
  }
  ForceContext context = s.force_context();
  for (uint32_t i = 0; i < s.forces.size(); ++i) {
    if (!s.forces[i]) continue;
    if (holds_particles(*s.forces[i])) {
      tumble::apply(*s.forces[i], context);
    } else if (anchors(*s.forces[i]).empty()) {
      fields_.push_back(i);
    } else {
      assign_anchored(i);
    }
  }
  for (const RigidBody& b : s.bodies.bodies) held_.emplace_back(b.force, b.torque);
  if (s.particles.empty()) return;
  for (const uint32_t i : fields_) tumble::apply(*s.forces[i], context);
}

/// The first body that the force can move answers for it, once for all of its ends.
void TickForces::assign_anchored(uint32_t force) {
  uint32_t first = ~uint32_t{0};
  for (const Anchor& a : anchors(*state_.forces[force])) {
    if (a.kind != Anchor::Kind::body) continue;
    const RigidBody* b = state_.bodies.find(a.body);
    if (b && b->dynamic()) first = std::min(first, a.body.index);
  }
  if (first < anchored_.size()) anchored_[first].push_back(force);
}

void TickForces::operator()(double t, std::span<const uint32_t> bodies) const {
  World::State& s = state_;
  for (const uint32_t slot : bodies) {
    RigidBody& b = s.bodies.bodies[slot];
    b.force = held_[slot].first + (b.mass * b.gravity_scale) * s.settings.gravity;
    b.torque = held_[slot].second;
  }
  ForceContext context = s.force_context();
  context.momentary = true;
  context.t += t;
  context.only = bodies;
  for (const uint32_t i : fields_) tumble::apply(*s.forces[i], context);
  for (const uint32_t slot : bodies)
    for (const uint32_t i : anchored_[slot]) tumble::apply(*s.forces[i], context);
}

}  // namespace tumble
