#include "engine/world/step_realtime.hpp"

#include "engine/dynamics/rigid/sleeping.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// What a failed tick must give back: everything that the stages change.
struct Backup {
  struct Motion {
    Pose pose;
    Vec3 v, omega;
    double sleep_time;
    bool asleep;
  };
  std::vector<Motion> bodies;
  ContactSet contacts;
  std::vector<ParticleSystem> particles;

  explicit Backup(const World::State& s) : contacts(s.contacts), particles(s.particles) {
    bodies.reserve(s.bodies.bodies.size());
    for (const RigidBody& b : s.bodies.bodies)
      bodies.push_back({b.pose, b.v, b.omega, b.sleep_time, b.asleep});
  }
  void restore(World::State& s) {
    s.contacts = std::move(contacts);
    s.particles = std::move(particles);
    for (size_t i = 0; i < bodies.size(); ++i) {
      RigidBody& b = s.bodies.bodies[i];
      b.pose = bodies[i].pose;
      b.v = bodies[i].v;
      b.omega = bodies[i].omega;
      b.sleep_time = bodies[i].sleep_time;
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
  for (const auto& force : s.forces)
    if (force) apply(*force, context);
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

Status run_stages(World::State& s) {
  const WorldSettings& settings = s.settings;
  const RealtimeSettings& tuning = settings.realtime;
  const double h = settings.tick.tick();
  std::vector<RigidBody>& bodies = s.bodies.bodies;
  {
    const ScopedStage stage(s.profiler, "forces");
    sum_forces(s);
  }
  {
    const ScopedStage stage(s.profiler, "broad phase");
    update_proxies(bodies, settings.gravity, h, tuning.speculative_margin, s.proxies);
    s.broad_phase->find_pairs(s.proxies.proxies, s.pairs);
  }
  {
    const ScopedStage stage(s.profiler, "narrow phase");
    const ContactUpdateStats stats =
        s.contacts.update(bodies, s.proxies, s.pairs, settings.gravity, h, tuning, *s.arena);
    s.stats.pairs = stats.pairs;
    s.stats.contacts = stats.contacts;
    s.stats.contact_points = stats.points;
    s.stats.max_penetration = stats.max_penetration;
  }
  {
    const ScopedStage stage(s.profiler, "islands");
    build_islands(bodies, s.contacts, spring_links(s), h, s.islands);
    s.stats.islands = s.islands.islands.size();
  }
  {
    const ScopedStage stage(s.profiler, "solve");
    if (tuning.continuous) s.continuous.remember(bodies, settings.gravity);
    const auto solved =
        s.solver.step(bodies, s.contacts, s.islands, settings.gravity, h, tuning, *s.arena);
    if (!solved) {
      const Status named = check_finite(s);
      return named ? solved.error() : named.error();
    }
  }
  if (tuning.continuous) {
    const ScopedStage stage(s.profiler, "continuous");
    s.continuous.apply(bodies, *s.broad_phase, h, tuning, *s.arena);
  }
  {
    const ScopedStage stage(s.profiler, "particles");
    for (ParticleSystem& p : s.particles) integrate(p, settings.gravity, h);
  }
  {
    const ScopedStage stage(s.profiler, "sleep");
    update_sleeping(bodies, s.islands, settings.gravity.norm(), h, tuning);
  }
  return check_finite(s);
}

}  // namespace

Status step_realtime(World::State& state) {
  Backup backup(state);
  Status status = run_stages(state);
  if (!status) backup.restore(state);
  return status;
}

}  // namespace tumble
