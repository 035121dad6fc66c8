#include "engine/world/tick_common.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// Pairs of bodies that springs tie together.
std::vector<BodyLink> spring_links(const World::State& s) {
  std::vector<BodyLink> links;
  for (const auto& force : s.forces) {
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    if (!spring || spring->a.kind != Anchor::Kind::body || spring->b.kind != Anchor::Kind::body)
      continue;
    if (s.bodies.ids.contains(spring->a.body) && s.bodies.ids.contains(spring->b.body))
      links.push_back({spring->a.body.index, spring->b.body.index});
  }
  return links;
}

}  // namespace

TickBackup::TickBackup(World::State& s)
    : joints_(s.joints.joints),
      event_contacts_(s.event.contacts),
      event_particles_(s.event.particles),
      touching_particles_(s.touching_particles),
      particles_(s.particles) {
  s.contacts.begin_tick();
  s.particle_contacts.begin_tick();
  bodies_.reserve(s.bodies.bodies.size());
  for (const RigidBody& b : s.bodies.bodies)
    bodies_.push_back({b.pose, b.v, b.omega, b.rest, b.asleep});
}

void TickBackup::restore(World::State& s) {
  s.contacts.go_back();
  s.joints.joints = std::move(joints_);
  s.event.contacts = std::move(event_contacts_);
  s.event.particles = std::move(event_particles_);
  s.particle_contacts.go_back();
  s.touching_particles = std::move(touching_particles_);
  s.particles = std::move(particles_);
  for (size_t i = 0; i < bodies_.size(); ++i) {
    RigidBody& b = s.bodies.bodies[i];
    b.pose = bodies_[i].pose;
    b.v = bodies_[i].v;
    b.omega = bodies_[i].omega;
    b.rest = bodies_[i].rest;
    b.asleep = bodies_[i].asleep;
  }
}

std::vector<Pose> TickBackup::poses() const {
  std::vector<Pose> out;
  out.reserve(bodies_.size());
  for (const Motion& m : bodies_) out.push_back(m.pose);
  return out;
}

std::vector<BodyLink> body_links(const World::State& s) {
  std::vector<BodyLink> links = spring_links(s);
  s.joints.add_links(links);
  return links;
}

std::vector<BodyLink> block_links(World::State& s) {
  std::vector<BodyLink> links;
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces) {
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    const RigidBody* a = spring ? pulled_body(spring->a, context) : nullptr;
    const RigidBody* b = spring ? pulled_body(spring->b, context) : nullptr;
    const RigidBody* first = s.bodies.bodies.data();
    if (a && b) links.push_back({uint32_t(a - first), uint32_t(b - first)});
  }
  s.joints.add_links(links);
  return links;
}

std::string body_label(const World::State& s, uint32_t slot) {
  if (s.blocks.holds(slot)) {
    const ParticleName name = s.blocks.name(slot);
    return fmt::format("particle {} of '{}'", name.particle, s.particles[name.system.index].name);
  }
  return fmt::format("body '{}' (slot {})", s.body_defs[slot] ? s.body_defs[slot]->name : "", slot);
}

Status check_finite(const World::State& s) {
  for (uint32_t i = 0; i < s.bodies.bodies.size(); ++i) {
    const RigidBody& b = s.bodies.bodies[i];
    if (b.pose.x.allFinite() && b.pose.q.coeffs().allFinite() && b.v.allFinite() &&
        b.omega.allFinite())
      continue;
    return Error{ErrorCode::numeric, "the state of a body is not finite",
                 fmt::format("tick {}, {}", s.tick + 1, body_label(s, i)),
                 "use a smaller tick, softer springs or smaller velocities"};
  }
  for (const ParticleSystem& p : s.particles) {
    for (size_t i = 0; i < p.size(); ++i) {
      if (p.x[i].allFinite() && p.v[i].allFinite()) continue;
      return Error{ErrorCode::numeric, "the state of a particle is not finite",
                   fmt::format("tick {}, particle {} of '{}'", s.tick + 1, p.id[i], p.name),
                   "use a smaller tick, softer springs or smaller velocities"};
    }
  }
  return {};
}

void integrate_particles(World::State& s) {
  const ScopedStage stage(s.profiler, "particles");
  for (size_t i = 0; i < s.particles.size(); ++i)
    if (!s.blocks.has_blocks(i))
      integrate(s.particles[i], s.settings.gravity, s.settings.tick.tick());
}

Status detect_particle_contacts(World::State& s, const TickBackup& start) {
  s.particle_detection.clear();
  if (!ParticleDetection::asked_for(s.particles)) return {};
  const ScopedStage stage(s.profiler, "particle contacts");
  return s.particle_detection.find(s.bodies, start.poses(), s.particle_ids, s.particles,
                                   start.particles(), s.settings.tick.tick(), *s.arena);
}

}  // namespace tumble
