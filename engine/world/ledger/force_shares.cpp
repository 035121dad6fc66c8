#include "engine/world/ledger/force_shares.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/anchor.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// A force on everything: its share is found by applying it to sums set to zero. It adds at most
/// once to each sum, so that adding the share to the old sums gives the same bits as applying it to
/// them.
void add_field(const ForceDef& def, ForceContext& context, SumsBefore& before, ForceShare& share) {
  const double held = has_potential(def) ? 1 : 0;
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
    if (!b.force.isZero(0) || !b.torque.isZero(0))
      share.bodies.push_back({i, b.force, b.torque, held * b.force, held * b.torque});
    b.force = before.force[i] + b.force;
    b.torque = before.torque[i] + b.torque;
  }
  for (uint32_t k = 0; k < context.particles.size(); ++k) {
    std::vector<Vec3>& force = context.particles[k].force;
    for (size_t i = 0; i < force.size(); ++i) {
      if (!force[i].isZero(0)) share.particles.push_back({k, i, force[i], held * force[i]});
      force[i] = before.particles[k][i] + force[i];
    }
  }
}

/// A force with anchors that is not a spring: only the sums of the anchors' bodies and particles
/// change.
void add_anchored(const ForceDef& def, const Anchors& ends, ForceContext& context,
                  ForceShare& share) {
  for (const Anchor& a : ends) {
    if (a.kind == Anchor::Kind::body && context.bodies.ids.contains(a.body)) {
      const RigidBody& b = context.bodies.bodies[a.body.index];
      if (share.bodies.empty() || share.bodies[0].slot != a.body.index)
        share.bodies.push_back({a.body.index, b.force, b.torque, Vec3::Zero(), Vec3::Zero()});
    } else if (a.kind == Anchor::Kind::particle && context.particle_ids.contains(a.particles)) {
      const ParticleSystem& p = context.particles[a.particles.index];
      const size_t i = p.find(a.particle);
      if (i < p.size()) share.particles.push_back({a.particles.index, i, p.force[i], Vec3::Zero()});
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

/// Adds the effect of a spring at one of its ends: a force, the conservative part of it, and an
/// additional torque.
void share_end(const Anchor& end, const Vec3& force, const Vec3& held, const Vec3& turn,
               ForceContext& context, ForceShare& share) {
  if (RigidBody* b = pulled_body(end, context)) {
    Vec3 arm = Vec3::Zero();
    if (end.kind == Anchor::Kind::body) arm = b->pose.direction(end.point - b->centre_body);
    const ForceShare::OnBody on{uint32_t(b - context.bodies.bodies.data()), force,
                                Vec3(arm.cross(force) + turn), held, arm.cross(held)};
    share.bodies.push_back(on);
    if (!b->dynamic()) return;
    b->force += on.force;
    b->torque += on.torque;
  } else if (end.kind == Anchor::Kind::particle && context.particle_ids.contains(end.particles)) {
    ParticleSystem& p = context.particles[end.particles.index];
    const size_t i = p.find(end.particle);
    if (i == p.size()) return;
    share.particles.push_back({end.particles.index, i, force, held});
    p.force[i] += force;
  }
}

void add_springs(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                 std::span<const uint8_t> supported, const SpringFilter& filter,
                 std::vector<ForceShare>& shares) {
  thread_local SpringsInSlots springs;
  thread_local NetPulls pulls;
  springs.clear();
  for (size_t i = 0; i < forces.size(); ++i)
    if (forces[i] && is_spring(*forces[i]) && (!filter || filter(i))) springs.add(*forces[i], i);
  if (stop_requested()) return;
  pull_springs(springs.all(), context, supported, pulls);
  if (stop_requested()) return;
  springs.share(pulls, context, shares);
}

}  // namespace

void share_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context,
                ForceShare& share) {
  share_end(spring.a, pull.force, pull.elastic, pull.turn_a, context, share);
  share_end(spring.b, -pull.force, -pull.elastic, pull.turn_b, context, share);
}

void share_pulls(const SpringMesh& mesh, std::span<const NodePull> pulls, ForceContext& context,
                 ForceShare& share) {
  for (size_t i = 0; i < pulls.size(); ++i)
    share_end(mesh.nodes[i], pulls[i].force, pulls[i].elastic, pulls[i].turn, context, share);
}

void SpringsInSlots::clear() {
  springs_.clear();
  meshes_.clear();
  spring_slots_.clear();
  mesh_slots_.clear();
}

bool SpringsInSlots::add(const ForceDef& def, size_t slot) {
  if (const auto* spring = std::get_if<SpringDef>(&def)) {
    springs_.push_back(spring);
    spring_slots_.push_back(slot);
  } else if (const auto* mesh = std::get_if<SpringMeshDef>(&def)) {
    meshes_.push_back(mesh);
    mesh_slots_.push_back(slot);
  }
  return is_spring(def);
}

void SpringsInSlots::share(const NetPulls& pulls, ForceContext& context,
                           std::vector<ForceShare>& shares) const {
  for (size_t k = 0; k < springs_.size(); ++k)
    share_pull(*springs_[k], pulls.springs[k], context, shares[spring_slots_[k]]);
  for (size_t k = 0; k < meshes_.size(); ++k)
    share_pulls(*meshes_[k]->mesh, pulls.meshes[k], context, shares[mesh_slots_[k]]);
}

void ForceShare::to_blocks(const ParticleBlocks& blocks) {
  for (const OnParticle& on : particles)
    if (blocks.has_blocks(on.system))
      bodies.push_back({blocks.first_slots()[on.system] + uint32_t(on.index), on.force,
                        Vec3::Zero(), on.held, Vec3::Zero()});
  std::erase_if(particles,
                [&blocks](const OnParticle& on) { return blocks.has_blocks(on.system); });
}

void sum_force_shares(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                      std::span<const uint8_t> supported, SumsBefore& scratch,
                      std::vector<ForceShare>& shares, const SpringFilter& filter) {
  shares.resize(forces.size());
  for (size_t i = 0; i < forces.size(); ++i) {
    shares[i].clear();
    if (stop_requested()) break;
    if (!forces[i] || is_spring(*forces[i])) continue;
    const Anchors ends = anchors(*forces[i]);
    if (ends.empty())
      add_field(*forces[i], context, scratch, shares[i]);
    else
      add_anchored(*forces[i], ends, context, shares[i]);
  }
  add_springs(forces, context, supported, filter, shares);
}

}  // namespace tumble
