#include "engine/world/held_particles.hpp"

#include "engine/world/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct Side {
  bool particle = false;
  uint32_t system = 0;
  size_t index = 0;
};

Side side_of(const WorldState& s, uint32_t slot) {
  if ((slot & particle_bit) == 0) return {};
  const ParticleName& name = s.touching_particles[slot & ~particle_bit];
  if (!s.particle_ids.contains(name.system)) return {};
  const ParticleSystem& p = s.particles[name.system.index];
  const size_t i = p.find(name.particle);
  return {i < p.size(), name.system.index, i};
}

/// A contact of a particle with a body, as a hold.
void add_hold(const WorldState& s, const Contact& c, std::vector<HeldParticle>& out) {
  const Side a = side_of(s, c.key.body_a), b = side_of(s, c.key.body_b);
  if (a.particle == b.particle) return;  // two particles hold each other as well as they can
  const Side& side = a.particle ? a : b;
  const uint32_t slot = a.particle ? c.key.body_b : c.key.body_a;
  if (slot >= s.bodies.bodies.size()) return;
  const RigidBody& body = s.bodies.bodies[slot];
  const ParticleSystem& p = s.particles[side.system];
  if (body.dynamic() && body.mass < tolerances::holding_mass_ratio * p.mass[side.index]) return;
  double pressed = 0;
  Vec3 rubbed = Vec3::Zero();
  for (const ContactPoint& point : c.used()) {
    pressed += point.normal_impulse;
    rubbed += point.friction_impulse;
  }
  if (!(pressed > 0)) return;
  HeldParticle held{side.system, side.index, {}};
  held.hold.presses = true;
  held.hold.normal = b.particle ? c.normal : Vec3(-c.normal);
  held.hold.friction = c.friction;
  const Vec3 surface = p.x[side.index] - p.radius[side.index] * held.hold.normal;
  const Vec3 belt = a.particle ? Vec3(-c.surface_velocity) : c.surface_velocity;
  held.hold.dv = body.velocity_at(surface) + belt - p.v[side.index];
  // It sticks where friction had something left in the tick before, and can stop what slip there is
  // in one.
  const Vec3 slip = held.hold.dv - held.hold.dv.dot(held.hold.normal) * held.hold.normal;
  held.hold.sticks = rubbed.norm() < tolerances::near_slipping * c.friction * pressed &&
                     p.mass[side.index] * slip.norm() <= c.friction * pressed;
  out.push_back(held);
}

}  // namespace

void find_apart(WorldState& s, PairFilter& out) {
  s.joints.find_apart(s.bodies.bodies, out);
  const ForceContext context = s.force_context();
  std::vector<uint32_t> slots;
  bool any = false;
  for (const auto& force : s.forces) {
    const auto* def = force ? std::get_if<SpringMeshDef>(&*force) : nullptr;
    if (!def) continue;
    slots.clear();
    for (const Anchor& node : def->mesh->nodes) {
      const RigidBody* body = pulled_body(node, context);
      slots.push_back(body ? uint32_t(body - s.bodies.bodies.data()) : ParticleBlocks::no_slot);
    }
    for (const SpringMesh::Link& l : def->mesh->links) {
      const uint32_t a = slots[l.a], b = slots[l.b];
      if (a == ParticleBlocks::no_slot || b == ParticleBlocks::no_slot || a == b) continue;
      if (!s.blocks.holds(a) && !s.blocks.holds(b)) continue;  // two bodies that a rope ties
      out.add(a, b);
      any = true;
    }
  }
  if (any) out.sort();
}

void find_held_particles(const WorldState& s, std::vector<HeldParticle>& out) {
  out.clear();
  s.particle_contacts.for_each([&](const Contact& c) { add_hold(s, c, out); });
  const auto place = [](const HeldParticle& h) { return std::pair{h.system, h.index}; };
  std::ranges::stable_sort(out, {}, place);
  size_t kept = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    if (kept > 0 && place(out[kept - 1]) == place(out[i]))
      out[kept - 1].hold.sticks = true;
    else
      out[kept++] = out[i];
  }
  out.resize(kept);
}

}  // namespace tumble
