#include "engine/world/step_realtime.hpp"

#include "engine/dynamics/rigid/sleeping.hpp"
#include "engine/dynamics/rigid/tick_parts.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// What a failed tick must give back: everything that the stages change.
struct Backup {
  struct Motion {
    Pose pose;
    Vec3 v, omega;
    RestWatch rest;
    bool asleep;
  };
  std::vector<Motion> bodies;
  ContactSet contacts;
  std::vector<ParticleSystem> particles;

  explicit Backup(const World::State& s) : contacts(s.contacts), particles(s.particles) {
    bodies.reserve(s.bodies.bodies.size());
    for (const RigidBody& b : s.bodies.bodies)
      bodies.push_back({b.pose, b.v, b.omega, b.rest, b.asleep});
  }
  void restore(World::State& s) {
    s.contacts = std::move(contacts);
    s.particles = std::move(particles);
    for (size_t i = 0; i < bodies.size(); ++i) {
      RigidBody& b = s.bodies.bodies[i];
      b.pose = bodies[i].pose;
      b.v = bodies[i].v;
      b.omega = bodies[i].omega;
      b.rest = bodies[i].rest;
      b.asleep = bodies[i].asleep;
    }
  }
};

void sum_forces(World::State& s) {
  for (RigidBody& b : s.bodies.bodies) {
    b.force.setZero();
    b.torque.setZero();
  }
  ForceContext context = s.force_context();
  sum_force_shares(s.forces, context, s.books.shares);
}

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

/// Particles never sleep, so neither does a body that a spring ties to one.
void wake_tied_to_particles(World::State& s) {
  for (const auto& force : s.forces) {
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    if (!spring) continue;
    for (const auto& [end, other] : {std::pair{spring->a, spring->b}, {spring->b, spring->a}})
      if (end.kind == Anchor::Kind::body && other.kind == Anchor::Kind::particle)
        if (RigidBody* b = s.bodies.find(end.body)) wake(*b);
  }
}

/// What rests in a field that changes by itself may not rest for long.
void wake_in_changing_fields(World::State& s) {
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces)
    if (force && varies_in_time(*force))
      for_targets(
          *field_targets(*force), context, [](RigidBody& b) { wake(b); },
          [](const ParticleSystem&) {});
}

/// Names the first body or particle whose state is not finite.
Status check_finite(const World::State& s) {
  for (uint32_t i = 0; i < s.bodies.bodies.size(); ++i) {
    const RigidBody& b = s.bodies.bodies[i];
    if (b.pose.x.allFinite() && b.pose.q.coeffs().allFinite() && b.v.allFinite() &&
        b.omega.allFinite())
      continue;
    return Error{ErrorCode::numeric, "the state of a body is not finite",
                 fmt::format("tick {}, body '{}' (slot {})", s.tick + 1,
                             s.body_defs[i] ? s.body_defs[i]->name : "", i),
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

void find_pairs(World::State& s, double h) {
  const ScopedStage stage(s.profiler, "broad phase");
  update_proxies(s.bodies.bodies, s.settings.gravity, h, s.settings.realtime.speculative_margin,
                 s.proxies);
  s.broad_phase->use_threads(s.arena.get());
  s.broad_phase->find_pairs(s.proxies.proxies, s.pairs);
  s.stats.bounds_tested += s.broad_phase->stats().tested;
  s.stats.pairs_found += s.broad_phase->stats().found;
}

void find_contacts(World::State& s, double h, const RealtimeSettings& tuning) {
  const ScopedStage stage(s.profiler, "narrow phase");
  const ContactUpdateStats stats =
      s.contacts.update(s.bodies.bodies, s.proxies, s.pairs, s.settings.gravity, h, tuning,
                        *s.arena, s.narrow_phase, s.hierarchy);
  s.stats.pairs = stats.pairs;
  s.stats.contacts = stats.contacts;
  s.stats.contact_points = stats.points;
  s.stats.max_penetration = stats.max_penetration;
}

Status solve(World::State& s, double h, const RealtimeSettings& tuning) {
  const ScopedStage stage(s.profiler, "solve");
  std::vector<RigidBody>& bodies = s.bodies.bodies;
  const Vec3& gravity = s.settings.gravity;
  if (tuning.continuous) s.continuous.remember(bodies, gravity);
  const auto solved = s.solver.step(bodies, s.contacts, s.islands, gravity, h, tuning, *s.arena);
  if (solved) return {};
  const Status named = check_finite(s);
  return named ? solved.error() : named.error();
}

/// From the pairs to new poses, over the tick or one part of it.
Status advance_part(World::State& s, double h, const RealtimeSettings& tuning) {
  find_contacts(s, h, tuning);
  {
    const ScopedStage stage(s.profiler, "islands");
    build_islands(s.bodies.bodies, s.contacts, spring_links(s), h, s.islands);
    s.stats.islands = s.islands.islands.size();
  }
  s.books.begin_part(s.bodies.bodies);
  if (const Status solved = solve(s, h, tuning); !solved) return solved;
  s.books.end_part(s.bodies.bodies, s.contacts, s.islands, s.forces, s.settings.gravity, h,
                   s.ledger);
  if (tuning.continuous) {
    const ScopedStage stage(s.profiler, "continuous");
    s.continuous.apply(s.bodies.bodies, *s.path_broad_phase, h, tuning, *s.arena,
                       s.continuous_methods);
    s.books.corrected(s.bodies.bodies, LedgerLine::projection, s.ledger);
  }
  return {};
}

Status run_stages(World::State& s) {
  const WorldSettings& settings = s.settings;
  const double h = settings.tick.tick();
  {
    const ScopedStage stage(s.profiler, "forces");
    wake_tied_to_particles(s);
    wake_in_changing_fields(s);
    sum_forces(s);
  }
  s.stats.bounds_tested = s.stats.pairs_found = 0;
  find_pairs(s, h);
  const int parts = tick_parts(s.bodies.bodies, s.proxies, s.pairs, h, settings.realtime);
  const RealtimeSettings tuning = part_settings(settings.realtime, parts);
  for (int part = 0; part < parts; ++part) {
    if (part > 0) find_pairs(s, h / parts);
    if (const Status done = advance_part(s, h / parts, tuning); !done) return done;
  }
  s.contacts.scale_impulses(parts, s.bodies.bodies);
  {
    const ScopedStage stage(s.profiler, "particles");
    s.books.particles(s.particles, s.forces, settings.gravity, h, s.ledger);
    for (ParticleSystem& p : s.particles) integrate(p, settings.gravity, h);
  }
  {
    const ScopedStage stage(s.profiler, "sleep");
    update_sleeping(s.bodies.bodies, s.islands, settings.gravity.norm(), h, settings.realtime);
    s.books.corrected(s.bodies.bodies, LedgerLine::sleeping, s.ledger);
  }
  return check_finite(s);
}

/// Contacts of particles over the tick that has just been computed.
Status detect_particle_contacts(World::State& s, const Backup& start) {
  s.particle_detection.clear();
  if (!ParticleDetection::asked_for(s.particles)) return {};
  const ScopedStage stage(s.profiler, "particle contacts");
  std::vector<Pose> poses;
  for (const Backup::Motion& m : start.bodies) poses.push_back(m.pose);
  return s.particle_detection.find(s.bodies, poses, s.particle_ids, s.particles, start.particles,
                                   s.settings.tick.tick(), *s.arena);
}

}  // namespace

Status step_realtime(World::State& state) {
  Backup backup(state);
  Status status = run_stages(state);
  if (status) status = detect_particle_contacts(state, backup);
  if (!status) backup.restore(state);
  return status;
}

}  // namespace tumble
