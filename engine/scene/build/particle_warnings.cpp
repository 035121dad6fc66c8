#include "engine/scene/build/particle_warnings.hpp"

#include "engine/collision/query.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/scene/build/near_pairs.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Fluid particles nearer than this share of their spacing count as coincident [-].
constexpr double fluid_coincidence = 0.3;
/// The same for colliding balls, as a share of their radius [-].
constexpr double ball_coincidence = 1e-3;
/// Greatest number of pairs that are counted.
constexpr size_t most_pairs = 10000;
/// Number of births examined for each emitter.
constexpr int births = 64;

std::string place_text(const Vec3& x) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z());
}

/// The particles of all systems that interact by contact.
struct Together {
  std::vector<Vec3> x;
  std::vector<const std::string*> system;
  double least_radius = std::numeric_limits<double>::infinity();

  void add(const std::string& name, const ParticleSystem& s) {
    x.insert(x.end(), s.x.begin(), s.x.end());
    system.insert(system.end(), s.x.size(), &name);
    for (const double r : s.radius) least_radius = std::min(least_radius, r);
  }
};

void look_at_places(const Together& all, double reach, const char* cure,
                    std::vector<std::string>& out) {
  if (all.x.size() < 2 || !(reach > 0) || !std::isfinite(reach)) return;
  const auto pairs = near_pairs(all.x, reach, most_pairs);
  if (pairs && pairs->empty()) return;
  if (!pairs) {
    out.push_back(
        fmt::format("particles.{}: more than {} pairs of particles begin on one place ({})",
                    *all.system[0], most_pairs, cure));
    return;
  }
  const auto [a, b] = pairs->front();
  const bool one = all.system[a] == all.system[b];
  out.push_back(fmt::format(
      "particles.{}: {} pair{} of particles begin{} on one place{}, the first at {} ({})",
      *all.system[a], pairs->size(), pairs->size() == 1 ? "" : "s", pairs->size() == 1 ? "s" : "",
      one ? "" : fmt::format(" with '{}'", *all.system[b]), place_text(all.x[a]), cure));
}

void look_at_particles(const BuiltScene& built, std::vector<std::string>& out) {
  Together fluids, balls;
  for (const auto& [name, id] : built.particles) {
    const ParticleSystem* s = built.world->particles(id);
    if (!s) continue;
    if (s->fluid)
      fluids.add(name, *s);
    else if (s->collide && !s->fast)
      balls.add(name, *s);
  }
  look_at_places(fluids, 2 * fluid_coincidence * fluids.least_radius,
                 "two fills of one place press each other apart: place them beside each other",
                 out);
  look_at_places(balls, ball_coincidence * balls.least_radius,
                 "nothing says which way they part: place them apart", out);
}

bool comes_by_itself(const EmitterDef& def) {
  return def.rate > 0 || !def.bursts.empty();
}

/// Positions in the world where an emitter creates particles or bodies.
std::vector<Vec3> births_of(const World& world, const Emitter& emitter) {
  const RigidBody* carrier = world.body(emitter.def->carrier);
  const Pose frame = carrier ? carrier->body_frame() * emitter.def->pose : emitter.def->pose;
  Random random(emitter.def->seed);
  std::vector<Vec3> out;
  for (int n = 0; n < births; ++n) out.push_back(frame.point(emitter.shape->draw(random).x));
  return out;
}

/// The number of points inside a body.
int points_in(const RigidBody& body, const std::vector<Vec3>& points) {
  int out = 0;
  for (const Vec3& p : points)
    out += std::ranges::any_of(body.shapes, [&](const BodyShape& s) {
      const Pose at = body.pose * s.pose;
      return s.shape->bounds(at).contains(p) && holds_point(*s.shape, at, p);
    });
  return out;
}

void look_at_births(const BuiltScene& built, std::vector<std::string>& out) {
  const World& world = *built.world;
  for (const auto& [name, id] : built.emitters) {
    const Emitter* emitter = world.emitter(id);
    if (!emitter || !emitter->shape || !comes_by_itself(*emitter->def)) continue;
    const ParticleSystem* system = world.particles(emitter->def->particles);
    if (system && !system->collide && !system->fluid) continue;
    const std::vector<Vec3> points = births_of(world, *emitter);
    for (const auto& [body_name, body_id] : built.bodies) {
      const RigidBody* body = world.body(body_id);
      if (!body || body_id == emitter->def->carrier || 2 * points_in(*body, points) <= births)
        continue;
      out.push_back(
          fmt::format("emitters.{}: what leaves it begins inside the body '{}' at {} (place it "
                      "outside)",
                      name, body_name, place_text(points[0])));
      break;
    }
  }
}

/// Reports emitters that neither their rate and bursts nor events of others trigger.
void look_at_silence(const BuiltScene& built, std::vector<std::string>& out) {
  std::set<std::string_view> called;
  for (const auto& [name, e] : built.description->emitters.items)
    for (const EmitterEventDescription& event : e.events) called.insert(event.emitter);
  for (const auto& [name, e] : built.description->emitters.items)
    if (!(e.rate > 0) && e.bursts.empty() && !called.contains(name))
      out.push_back(fmt::format(
          "emitters.{}: nothing comes from it: it has no rate and no bursts, and no event names it",
          name));
}

void look_at_sinks(const BuiltScene& built, std::vector<std::string>& out) {
  const World& world = *built.world;
  for (const auto& [name, id] : built.sinks) {
    const SinkDef* sink = world.sink(id);
    if (!sink) continue;
    size_t taken = 0, all = 0;
    const auto takes = [&](ParticleSystemId system) {
      return sink->takes_particles &&
             (sink->systems.empty() || std::ranges::count(sink->systems, system) > 0);
    };
    for (const auto& [system_name, system] : built.particles) {
      const ParticleSystem* s = world.particles(system);
      if (!s || !takes(system)) continue;
      for (const Vec3& x : s->x) taken += holds(*sink, x);
      all += s->size();
    }
    if (sink->takes_bodies)
      for (const auto& [body_name, body] : built.bodies) {
        const RigidBody* b = world.body(body);
        if (!b || b->type != BodyType::dynamic) continue;
        taken += holds(*sink, b->pose.x);
        ++all;
      }
    if (all > 0 && taken == all)
      out.push_back(fmt::format(
          "sinks.{}: all that it takes is in it at the start: {} particles or bodies vanish in the "
          "first ticks (\"outside\": true takes what leaves it)",
          name, all));
    for (const auto& [emitter_name, emitter_id] : built.emitters) {
      const Emitter* emitter = world.emitter(emitter_id);
      if (!emitter || !emitter->shape || !comes_by_itself(*emitter->def)) continue;
      const bool of_it = emitter->def->body ? sink->takes_bodies : takes(emitter->def->particles);
      if (!of_it) continue;
      const std::vector<Vec3> points = births_of(world, *emitter);
      if (std::ranges::all_of(points, [&](const Vec3& x) { return holds(*sink, x); }))
        out.push_back(fmt::format(
            "sinks.{}: takes at once what comes from the emitter '{}' at {} (place one elsewhere)",
            name, emitter_name, place_text(points[0])));
    }
  }
}

void look_at_periodic_boxes(const BuiltScene& built, std::vector<std::string>& out) {
  for (const auto& [name, id] : built.particles) {
    const ParticleSystem* s = built.world->particles(id);
    if (!s || s->x.empty()) continue;
    const Vec3 &low = s->box.low, size = s->box.size;
    const double widest = 2 * *std::max_element(s->radius.begin(), s->radius.end());
    size_t outside = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
      if (size[k] > 0) shortest = std::min(shortest, size[k]);
    for (const Vec3& x : s->x) {
      bool in = true;
      for (int k = 0; k < 3; ++k)
        in = in && (!(size[k] > 0) || (x[k] >= low[k] && x[k] <= low[k] + size[k]));
      outside += !in;
    }
    if (shortest < widest)
      out.push_back(fmt::format(
          "particles.{}.periodic_box: is {:.4g} m long, less than a particle, which is {:.4g} m "
          "wide and meets itself (a larger box)",
          name, shortest, widest));
    if (outside > 0)
      out.push_back(fmt::format(
          "particles.{}.periodic_box: {} of {} particles begin outside and are moved into it by "
          "whole lengths of the box (give it their centre, or place them inside)",
          name, outside, s->size()));
  }
}

/// Weakly compressible fluids are compressed by about (v / c)^2: one percent, if the speed after
/// falling through the fluid's depth is a tenth of the speed of sound c (Monaghan, "Simulating free
/// surface flows with SPH", 1994).
void look_at_sound(const BuiltScene& built, std::vector<std::string>& out) {
  const Vec3 g = built.world->settings().gravity.now();
  for (const auto& [name, id] : built.particles) {
    const ParticleSystem* s = built.world->particles(id);
    if (!s || !s->fluid || s->fluid->solver != FluidSolverKind::wcsph || s->x.empty()) continue;
    const double c = s->fluid->sound_speed;
    if (!(c > 0)) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& x : s->x) {
      const double height = -x.dot(g);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    const double fall = std::sqrt(2 * std::fabs(s->gravity_scale) * std::max(0.0, high - low));
    if (c >= 10 * fall) continue;
    out.push_back(fmt::format(
        "particles.{}.fluid.sound_speed: {:.4g} m/s is less than ten times {:.4g} m/s, that of a "
        "fall through its depth: it is squeezed by more than a hundredth ({:.3g} m/s, or 0)",
        name, c, fall, 10 * fall));
  }
}

}  // namespace

std::vector<std::string> particle_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  look_at_particles(built, out);
  look_at_silence(built, out);
  look_at_births(built, out);
  look_at_sinks(built, out);
  look_at_periodic_boxes(built, out);
  look_at_sound(built, out);
  return out;
}

}  // namespace tumble
