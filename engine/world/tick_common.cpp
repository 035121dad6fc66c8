#include "engine/world/tick_common.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/realtime/tick.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Links each moving node of a mesh with the next, as a mesh moves as a whole.
void link_mesh(const SpringMesh& mesh, const ForceContext& context, std::vector<BodyLink>& links) {
  uint32_t last = ParticleBlocks::no_slot;
  for (const Anchor& node : mesh.nodes) {
    const RigidBody* body = pulled_body(node, context);
    if (!body || !body->dynamic()) continue;
    const auto slot = uint32_t(body - context.bodies.bodies.data());
    if (last != ParticleBlocks::no_slot && last != slot) links.push_back({last, slot});
    last = slot;
  }
}

/// Adds the pairs of bodies that springs connect.
void add_spring_links(WorldState& s, std::vector<BodyLink>& links) {
  for (const auto& force : s.forces) {
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    if (!spring || spring->a.kind != Anchor::Kind::body || spring->b.kind != Anchor::Kind::body)
      continue;
    if (s.bodies.ids.contains(spring->a.body) && s.bodies.ids.contains(spring->b.body))
      links.push_back({spring->a.body.index, spring->b.body.index});
  }
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces)
    if (const auto* mesh = force ? std::get_if<SpringMeshDef>(&*force) : nullptr)
      link_mesh(*mesh->mesh, context, links);
}

/// Links each block with the next among particles that a pair potential couples.
void link_paired(const WorldState& s, const ForceDef& force, std::vector<BodyLink>& links) {
  const auto* systems = paired_systems(force);
  if (!systems) return;
  uint32_t last = ParticleBlocks::no_slot;
  for (uint32_t k = 0; k < s.particles.size(); ++k) {
    if (!s.blocks.has_blocks(k) || !s.particle_ids.alive(k)) continue;
    if (!systems->empty() && std::ranges::find(*systems, s.particle_ids.at(k)) == systems->end())
      continue;
    const uint32_t first = s.blocks.first_slots()[k];
    for (uint32_t slot = first; slot < first + s.particles[k].size(); ++slot) {
      if (last != ParticleBlocks::no_slot) links.push_back({last, slot});
      last = slot;
    }
  }
}

/// One sum suffices in the usual case: a value that is not finite makes the sum not finite.
bool finite(const RigidBody& b) {
  return std::isfinite(b.pose.x.sum() + b.pose.q.coeffs().sum() + b.v.sum() + b.omega.sum()) ||
         (b.pose.x.allFinite() && b.pose.q.coeffs().allFinite() && b.v.allFinite() &&
          b.omega.allFinite());
}

bool finite(const ParticleSystem& p, size_t i) {
  return p.x[i].allFinite() && p.v[i].allFinite();
}

}  // namespace

const std::vector<BodyLink>& body_links(WorldState& s) {
  s.workspace.links.clear();
  add_spring_links(s, s.workspace.links);
  const std::span<const BodyLink> nets = s.workspace.pressed_nets.links();
  s.workspace.links.insert(s.workspace.links.end(), nets.begin(), nets.end());
  s.joints.add_links(s.workspace.links);
  return s.workspace.links;
}

std::vector<BodyLink> block_links(WorldState& s) {
  std::vector<BodyLink> links;
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces) {
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    const RigidBody* a = spring ? pulled_body(spring->a, context) : nullptr;
    const RigidBody* b = spring ? pulled_body(spring->b, context) : nullptr;
    const RigidBody* first = s.bodies.bodies.data();
    if (a && b) links.push_back({uint32_t(a - first), uint32_t(b - first)});
    if (const auto* mesh = force ? std::get_if<SpringMeshDef>(&*force) : nullptr)
      link_mesh(*mesh->mesh, context, links);
  }
  s.joints.add_links(links);
  for (const auto& force : s.forces)
    if (force) link_paired(s, *force, links);
  return links;
}

std::string body_label(const WorldState& s, uint32_t slot) {
  if (s.blocks.holds(slot)) {
    const ParticleName name = s.blocks.name(slot);
    return fmt::format("particle {} of '{}'", name.particle, s.particles[name.system.index].name);
  }
  return fmt::format("body '{}' (slot {})", s.body_defs[slot] ? s.body_defs[slot]->name : "", slot);
}

Status check_finite(const WorldState& s) {
  const std::vector<RigidBody>& bodies = s.bodies.bodies;
  const bool some = !s.roster.everything();
  const std::span<const uint32_t> active = s.roster.active();
  std::array<bool, chunk_count> broken{};
  for_chunks(s.crew.get(), some ? active.size() : bodies.size(),
             [&](size_t chunk, size_t first, size_t last) {
               for (size_t k = first; k < last; ++k)
                 broken[chunk] = broken[chunk] || !finite(bodies[some ? active[k] : k]);
             });
  const bool all_finite = std::ranges::none_of(broken, std::identity());
  for (uint32_t i = 0; !all_finite && i < bodies.size(); ++i) {
    if (finite(bodies[i])) continue;
    return Error{ErrorCode::numeric, "the state of a body is not finite",
                 fmt::format("tick {}, {}", s.tick + 1, body_label(s, i)),
                 "use a smaller tick, softer springs or smaller velocities"};
  }
  for (const ParticleSystem& p : s.particles) {
    std::atomic<bool> fine = true;
    for_chunks(s.crew.get(), p.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        if (!finite(p, i)) fine.store(false, std::memory_order_relaxed);
    });
    for (size_t i = 0; !fine && i < p.size(); ++i) {
      if (finite(p, i)) continue;
      return Error{ErrorCode::numeric, "the state of a particle is not finite",
                   fmt::format("tick {}, particle {} of '{}'", s.tick + 1, p.id[i], p.name),
                   "use a smaller tick, softer springs or smaller velocities"};
    }
  }
  return {};
}

RealtimeTick realtime_tick(WorldState& s, const TickChoice& choice) {
  return {.settings = choice.settings,
          .gravity = s.settings.gravity.now(),
          .h = s.settings.tick.tick(),
          .broad_phase = *s.methods.broad_phase,
          .path_broad_phase = *s.methods.path_broad_phase,
          .continuous_methods = s.methods.continuous,
          .narrow_phase = s.methods.narrow_phase,
          .hierarchy = s.methods.hierarchy,
          .bodies = s.bodies.bodies,
          .joints = s.joints.joints,
          .couplings = s.joints.couplings,
          .links = choice.links,
          .apart = choice.apart,
          .roster = s.roster,
          .proxies = s.workspace.proxies,
          .pairs = s.workspace.pairs,
          .contacts = choice.contacts,
          .islands = s.islands,
          .solver = s.workspace.solver,
          .continuous = s.workspace.continuous,
          .sleep_scratch = s.workspace.sleep_scratch,
          .crew = *s.crew,
          .profiler = s.profiler,
          .listener = choice.listener,
          .courses = choice.courses};
}

Status outcome_of_tick(const WorldState& s, Status status) {
  if (!stop_requested() && status) return status;
  const std::string tick = fmt::format("tick {}", s.tick + 1);
  Error error = stop_requested() ? stopped_error() : status.error();
  if (error.place.empty())
    error.place = tick;
  else if (!error.place.starts_with("tick "))
    error.place = tick + ", " + error.place;
  return error;
}

Status outcome_of_stages(const WorldState& s, const TickReport& report, const Status& done) {
  if (done) return {};
  if (report.crowded) {
    Error error = done.error();
    error.place = "about " + body_label(s, *report.crowded);
    return error;
  }
  const Status named = check_finite(s);
  return named ? done : named;
}

void integrate_particles(WorldState& s) {
  const ScopedStage stage(s.profiler, "particles");
  for (size_t i = 0; i < s.particles.size(); ++i)
    if (!s.blocks.has_blocks(i) && !s.particles[i].fluid && !s.particles[i].grains)
      integrate(s.particles[i], s.settings.gravity.now(), s.settings.tick.tick());
}

void finish_particles(WorldState& s) {
  for (ParticleSystem& p : s.particles) {
    if (p.box.any())
      for (Vec3& x : p.x) x = p.box.wrapped(x);
    note_quantity(p);
  }
}

Status detect_particle_contacts(WorldState& s, const TickBackup& start) {
  s.particle_detection.clear();
  if (!ParticleDetection::asked_for(s.particles)) return {};
  const ScopedStage stage(s.profiler, "particle contacts");
  return s.particle_detection.find(s.bodies, start.poses(), s.particle_ids, s.particles,
                                   start.particles(), s.settings.tick.tick(), *s.crew);
}

}  // namespace tumble
