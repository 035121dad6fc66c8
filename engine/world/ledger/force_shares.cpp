#include "engine/world/ledger/force_shares.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/anchor.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// A force on everything: what it adds shows by setting the sums to zero for it. Each of them adds
/// once to a sum, so that the bits of the sums are those of adding it at once.
void add_field(const ForceDef& def, ForceContext& context, SumsBefore& before, ForceShare& share) {
  std::vector<RigidBody>& bodies = context.bodies.bodies;
  before.force.resize(bodies.size());
  before.torque.resize(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    before.force[i] = bodies[i].force;
    before.torque[i] = bodies[i].torque;
    bodies[i].force.setZero();
    bodies[i].torque.setZero();
  }
  before.particles.resize(context.particles.size());
  for (size_t k = 0; k < context.particles.size(); ++k) {
    std::vector<Vec3>& force = context.particles[k].force;
    before.particles[k].swap(force);
    force.assign(before.particles[k].size(), Vec3::Zero());
  }
  apply(def, context);
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    RigidBody& b = bodies[i];
    if (!b.force.isZero(0) || !b.torque.isZero(0)) share.bodies.push_back({i, b.force, b.torque});
    b.force = before.force[i] + b.force;
    b.torque = before.torque[i] + b.torque;
  }
  for (uint32_t k = 0; k < context.particles.size(); ++k) {
    std::vector<Vec3>& force = context.particles[k].force;
    for (size_t i = 0; i < force.size(); ++i) {
      if (!force[i].isZero(0)) share.particles.push_back({k, i, force[i]});
      force[i] = before.particles[k][i] + force[i];
    }
  }
}

/// The part of a spring's pull that its potential explains.
double elastic_part(const SpringDef& def, const ForceContext& context, const ForceShare& share) {
  const auto a = locate(def.a, context), b = locate(def.b, context);
  if (!a || !b) return 0;
  const Vec3 d = (b->x_world + lead_of(def.b, context) * b->v_world) -
                 (a->x_world + lead_of(def.a, context) * a->v_world);
  const double elastic = def.stiffness * (d.norm() - def.rest_length);
  if (share.bodies.empty() && share.particles.empty()) return 0;
  // Which way it pulls: at end a along d.
  const Vec3 force = share.bodies.empty() ? share.particles[0].force : share.bodies[0].force;
  const RigidBody* const body_a = pulled_body(def.a, context);
  const bool at_a = share.bodies.empty()
                        ? def.a.kind == Anchor::Kind::particle
                        : body_a && body_a == &context.bodies.bodies[share.bodies[0].slot];
  const double pull = (at_a ? 1 : -1) * force.dot(d.normalized());
  return pull != 0 ? elastic / pull : 0;
}

/// A force between anchors: only the sums of these change.
void add_anchored(const ForceDef& def, const Anchors& ends, ForceContext& context,
                  ForceShare& share) {
  for (const Anchor& a : ends) {
    if (a.kind == Anchor::Kind::body && context.bodies.ids.contains(a.body)) {
      const RigidBody& b = context.bodies.bodies[a.body.index];
      if (share.bodies.empty() || share.bodies[0].slot != a.body.index)
        share.bodies.push_back({a.body.index, b.force, b.torque});
    } else if (a.kind == Anchor::Kind::particle && context.particle_ids.contains(a.particles)) {
      const ParticleSystem& p = context.particles[a.particles.index];
      const size_t i = p.find(a.particle);
      if (i < p.size()) share.particles.push_back({a.particles.index, i, p.force[i]});
    }
  }
  apply(def, context);
  for (ForceShare::OnBody& on : share.bodies) {
    on.force = context.bodies.bodies[on.slot].force - on.force;
    on.torque = context.bodies.bodies[on.slot].torque - on.torque;
  }
  for (ForceShare::OnParticle& on : share.particles)
    on.force = context.particles[on.system].force[on.index] - on.force;
}

}  // namespace

double conserved_part(const ForceDef& def, const ForceContext& context, const ForceShare& share) {
  if (const auto* spring = std::get_if<SpringDef>(&def))
    return elastic_part(*spring, context, share);
  return has_potential(def) ? 1 : 0;
}

void sum_force_shares(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                      SumsBefore& scratch, std::vector<ForceShare>& shares) {
  shares.resize(forces.size());
  for (size_t i = 0; i < forces.size(); ++i) {
    ForceShare& share = shares[i];
    share.clear();
    if (stop_requested()) break;
    if (!forces[i]) continue;
    const Anchors ends = anchors(*forces[i]);
    if (ends.empty())
      add_field(*forces[i], context, scratch, share);
    else
      add_anchored(*forces[i], ends, context, share);
    share.conserved = conserved_part(*forces[i], context, share);
  }
}

}  // namespace tumble
