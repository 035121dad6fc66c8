#include "engine/world/sensors/sense.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/radial_distribution.hpp"
#include "engine/world/sensors/tolerances.hpp"
#include "engine/world/state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

/// World pose of a sensor's frame on a body, given the pose of the body's centre of mass frame.
Pose on_carrier(const SensorDef& def, const RigidBody& carrier, const Pose& centre) {
  const Pose body{centre.x - centre.direction(carrier.centre_body), centre.q};
  return body * def.pose;
}

bool chosen(const SensorDef& def, BodyId body) {
  return def.only_bodies.empty() ||
         std::ranges::find(def.only_bodies, body) != def.only_bodies.end();
}

bool chosen(const SensorDef& def, ParticleSystemId system) {
  return def.only_systems.empty() ||
         std::ranges::find(def.only_systems, system) != def.only_systems.end();
}

bool looks_at_bodies(const SensorDef& def) {
  return def.bodies && (!def.only_bodies.empty() || def.only_systems.empty());
}

bool looks_at_particles(const SensorDef& def) {
  return def.particles && (!def.only_systems.empty() || def.only_bodies.empty());
}

/// Calls f for every live sensor of a kind, with its slot.
template <class F>
void for_kind(const SensorSet& sensors, SensorKind kind, const F& f) {
  for (uint32_t i = 0; i < sensors.defs.size(); ++i)
    if (sensors.ids.alive(i) && sensors.defs[i].kind == kind) f(i);
}

void find_body_paths(WorldState& s, std::vector<CentrePath>& out) {
  out.clear();
  for (uint32_t slot = 0; slot < s.bodies.bodies.size(); ++slot) {
    const RigidBody& b = s.bodies.bodies[slot];
    if (!s.bodies.ids.alive(slot) || !b.dynamic()) continue;
    out.push_back({s.before.backup.pose(slot).x, b.pose.x, b.mass, s.bodies.ids.at(slot)});
  }
}

/// Paths of the particles of `now`: each is also in `start` (ids ascend in both), or was born in
/// the tick.
void find_particle_paths(const ParticleSystem& start, const ParticleSystem& now,
                         std::vector<CentrePath>& out) {
  size_t k = 0;
  for (size_t i = 0; i < now.size(); ++i) {
    while (k < start.size() && start.id[k] < now.id[i]) ++k;
    const bool was_there = k < start.size() && start.id[k] == now.id[i];
    const Vec3 from = was_there ? start.x[k] : now.x[i] - now.age[i] * now.v[i];
    out.push_back({from, from + start.box.shortest(now.x[i] - from), now.mass[i], {}});
  }
}

void find_particle_paths(WorldState& s, std::vector<std::vector<CentrePath>>& out) {
  out.resize(s.particles.size());
  const std::vector<ParticleSystem>& start = s.before.backup.particles();
  const std::vector<ParticleSystem>& dead = s.workspace.emission.dead;
  for (uint32_t k = 0; k < s.particles.size(); ++k) {
    out[k].clear();
    if (!s.particle_ids.alive(k)) continue;
    find_particle_paths(start[k], s.particles[k], out[k]);
    if (k < dead.size()) find_particle_paths(start[k], dead[k], out[k]);
  }
}

/// What passed through a gate in a tick.
struct Tally {
  uint64_t forward = 0, backward = 0;
  double mass_forward = 0, mass_backward = 0;

  void add(const Tally& other) {
    forward += other.forward;
    backward += other.backward;
    mass_forward += other.mass_forward;
    mass_backward += other.mass_backward;
  }
  void add(int way, double mass) {
    (way > 0 ? forward : backward) += 1;
    (way > 0 ? mass_forward : mass_backward) += mass;
  }
};

/// A gate, with its frame at both ends of the tick.
struct MovingGate {
  const SensorDef& def;
  Pose from, to;

  Tally count(std::span<const CentrePath> paths, Crew* crew) const {
    std::array<Tally, chunk_count> parts{};
    for_chunks(crew, paths.size(), [&](size_t chunk, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const CentrePath& p = paths[i];
        if (!p.body.is_null() && (p.body == def.carrier || !chosen(def, p.body))) continue;
        const int way = passage(def.shape, from.inverse_point(p.from), to.inverse_point(p.to));
        if (way != 0) parts[chunk].add(way, p.mass);
      }
    });
    Tally sum;
    for (const Tally& part : parts) sum.add(part);
    return sum;
  }
};

void note(const Tally& tally, const SensorDef& def, double now, double h, SensorState& state) {
  state.forward += tally.forward;
  state.backward += tally.backward;
  state.mass_forward += tally.mass_forward;
  state.mass_backward += tally.mass_backward;
  const double mass = tally.mass_forward - tally.mass_backward;
  if (mass != 0) state.recent.push_back({now, mass});
  const double span = std::max(std::round(def.span / h), 1.0) * h;
  const double first = now - span + 0.5 * h;  // half a tick against rounding of times
  std::erase_if(state.recent, [first](const Passage& p) { return p.time < first; });
  double sum = 0;
  for (const Passage& p : state.recent) sum += p.mass;
  state.flow = sum / std::clamp(now - state.begun, h, span);
}

void sense_gates(WorldState& s) {
  const SensorSet& sensors = s.sensors;
  SensorScratch& scratch = s.workspace.sensors;
  bool any = false, bodies = false, particles = false;
  for_kind(sensors, SensorKind::gate, [&](uint32_t i) {
    any = true;
    bodies = bodies || looks_at_bodies(sensors.defs[i]);
    particles = particles || looks_at_particles(sensors.defs[i]);
  });
  if (!any) return;
  if (bodies) find_body_paths(s, scratch.bodies);
  if (particles) find_particle_paths(s, scratch.particles);
  for_kind(sensors, SensorKind::gate, [&](uint32_t i) {
    const SensorDef& def = sensors.defs[i];
    MovingGate gate{def, def.pose, def.pose};
    Tally tally;
    const RigidBody* carrier = s.bodies.find(def.carrier);
    if (carrier) {
      gate.from = on_carrier(def, *carrier, s.before.backup.pose(def.carrier.index));
      gate.to = on_carrier(def, *carrier, carrier->pose);
    }
    if (carrier || def.carrier.is_null()) {
      if (looks_at_bodies(def)) tally.add(gate.count(scratch.bodies, s.crew.get()));
      if (looks_at_particles(def))
        for (uint32_t k = 0; k < s.particles.size(); ++k)
          if (s.particle_ids.alive(k) && chosen(def, s.particle_ids.at(k)))
            tally.add(gate.count(scratch.particles[k], s.crew.get()));
    }
    note(tally, def, s.time(), s.settings.tick.tick(), s.sensors.states[i]);
  });
}

/// State of a contact sensor while the contacts are visited.
struct Touch {
  bool pressed = false, near = false;
  Vec3 impulse = Vec3::Zero();  ///< on a [N s]
};

Touch look_up(const WorldState& s, const SensorDef& def, double rattle) {
  Touch out;
  const auto look = [&](const Contact& c) {
    const bool first = c.key.body_a == def.a.index;
    if (!first && c.key.body_b != def.a.index) return;
    const uint32_t other = first ? c.key.body_b : c.key.body_a;
    if (!def.b.is_null() && other != def.b.index) return;
    for (int i = 0; i < c.count; ++i) {
      const Vec3 on_b = contact_impulse(c, i);
      out.impulse += first ? Vec3(-on_b) : on_b;
      out.near = out.near || c.points[size_t(i)].gap <= rattle;
    }
    out.pressed = out.pressed || c.pressed();
  };
  for (const Contact& c : s.contacts.contacts()) look(c);
  // Contacts between bodies at rest may be with a fixed or kinematic body, which is not itself at
  // rest.
  if (!s.bodies.bodies[def.a.index].dynamic() || s.contacts.rests(def.a.index))
    for (const Contact* c : s.contacts.resting()) look(*c);
  return out;
}

void sense_contacts(WorldState& s) {
  const double h = s.settings.tick.tick();
  const double rattle = tolerances::rattle_gap * s.settings.gravity.now().norm() * h * h;
  for_kind(s.sensors, SensorKind::contact, [&](uint32_t i) {
    const SensorDef& def = s.sensors.defs[i];
    SensorState& state = s.sensors.states[i];
    const bool there = s.bodies.find(def.a) && (def.b.is_null() || s.bodies.find(def.b));
    const Touch touch = there ? look_up(s, def, rattle) : Touch{};
    const bool touching = touch.pressed || (state.touching && touch.near);
    if (touching && !state.touching) ++state.touches;
    state.touching = touching;
    state.force = touch.impulse / h;
  });
}

/// What is in a region now.
void fill_region(const WorldState& s, const SensorDef& def, SensorFrame& out) {
  if (looks_at_bodies(def))
    for (uint32_t slot = 0; slot < s.bodies.bodies.size(); ++slot) {
      const RigidBody& b = s.bodies.bodies[slot];
      if (!s.bodies.ids.alive(slot) || !b.dynamic()) continue;
      const BodyId id = s.bodies.ids.at(slot);
      if (id == def.carrier || !chosen(def, id)) continue;
      if (!holds(def.shape, out.pose.inverse_point(b.pose.x))) continue;
      out.inside.push_back(id);
      out.mass += b.mass;
    }
  if (!looks_at_particles(def)) return;
  for (uint32_t k = 0; k < s.particles.size(); ++k) {
    if (!s.particle_ids.alive(k) || !chosen(def, s.particle_ids.at(k))) continue;
    const ParticleSystem& p = s.particles[k];
    for (size_t i = 0; i < p.size(); ++i) {
      if (!holds(def.shape, out.pose.inverse_point(p.x[i]))) continue;
      ++out.particles;
      out.mass += p.mass[i];
    }
  }
}

/// At what distances from each other the particles are now. Particles in boxes of different sizes,
/// which a scene may not ask for, have no distances.
void fill_radial(const WorldState& s, const SensorDef& def, SensorFrame& out) {
  std::vector<Vec3> points;
  std::optional<PeriodicBox> box;
  bool one_box = true;
  for (const ParticleSystemId id : def.only_systems) {
    if (!s.particle_ids.contains(id)) continue;
    const ParticleSystem& p = s.particles[id.index];
    points.insert(points.end(), p.x.begin(), p.x.end());
    if (!box) box = p.box;
    one_box = one_box && box->size == p.box.size;
  }
  out.gone = !box || !one_box;
  if (out.gone) points.clear();
  out.shells = radial_distribution(points, box.value_or(PeriodicBox{}), def.range, def.shells);
}

void fill(const WorldState& s, uint32_t slot, SensorFrame& out) {
  const SensorDef& def = s.sensors.defs[slot];
  const SensorState& state = s.sensors.states[slot];
  out.id = s.sensors.ids.at(slot);
  out.name = def.name;
  out.kind = def.kind;
  out.shape = def.shape;
  out.carrier = def.carrier;
  out.a = def.a;
  out.b = def.b;
  const RigidBody* carrier = s.bodies.find(def.carrier);
  out.gone = !def.carrier.is_null() && !carrier;
  out.pose = carrier ? on_carrier(def, *carrier, carrier->pose) : def.pose;
  out.forward = state.forward;
  out.backward = state.backward;
  out.mass_forward = state.mass_forward;
  out.mass_backward = state.mass_backward;
  out.flow = state.flow;
  out.touching = state.touching;
  out.touches = state.touches;
  out.force = state.force;
  out.inside.clear();
  out.particles = 0;
  out.mass = 0;
  if (def.kind == SensorKind::contact) out.gone = !s.bodies.find(def.a);
  if (def.kind == SensorKind::region && !out.gone) fill_region(s, def, out);
  out.range = def.range;
  out.shells.clear();
  if (def.kind == SensorKind::radial) fill_radial(s, def, out);
}

}  // namespace

void sense_tick(WorldState& s) {
  if (s.sensors.empty()) return;
  const ScopedStage stage(s.profiler, "sensors");
  sense_gates(s);
  sense_contacts(s);
}

bool sensing_goes_on(const WorldState& s) {
  return std::ranges::any_of(s.sensors.states,
                             [](const SensorState& state) { return !state.recent.empty(); });
}

void make_sensor_frames(const WorldState& s, std::vector<SensorFrame>& out) {
  out.resize(s.sensors.ids.count());
  auto next = out.begin();
  for (uint32_t i = 0; i < s.sensors.defs.size(); ++i)
    if (s.sensors.ids.alive(i)) fill(s, i, *next++);
}

namespace {

/// "g.0", "g.1", ...
std::string_view shell_name(size_t k) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (size_t i = 0; i < SensorDef::most_shells; ++i) all.push_back("g." + std::to_string(i));
    return all;
  }();
  return names[k];
}

/// The highest shell, and the distance of its middle; then all.
std::vector<SensorValue> radial_values(const SensorFrame& s) {
  const auto highest = std::ranges::max_element(s.shells);
  const bool any = highest != s.shells.end() && *highest > 0;
  const double thickness = s.shells.empty() ? 0 : s.range / double(s.shells.size());
  std::vector<SensorValue> out = {
      {"peak", "", any ? *highest : 0},
      {"peak_distance", "m", any ? (double(highest - s.shells.begin()) + 0.5) * thickness : 0}};
  for (size_t k = 0; k < s.shells.size(); ++k) out.push_back({shell_name(k), "", s.shells[k]});
  return out;
}

}  // namespace

std::vector<SensorValue> sensor_values(const SensorFrame& s) {
  switch (s.kind) {
    case SensorKind::gate:
      return {{"count", "", double(s.forward + s.backward)},
              {"forward", "", double(s.forward)},
              {"backward", "", double(s.backward)},
              {"mass", "kg", s.mass_forward + s.mass_backward},
              {"mass_forward", "kg", s.mass_forward},
              {"mass_backward", "kg", s.mass_backward},
              {"flow", "kg/s", s.flow}};
    case SensorKind::region:
      return {{"count", "", double(s.inside.size() + s.particles)},
              {"bodies", "", double(s.inside.size())},
              {"particles", "", double(s.particles)},
              {"mass", "kg", s.mass}};
    case SensorKind::radial:
      return radial_values(s);
    case SensorKind::contact:
      break;
  }
  return {{"touching", "", s.touching ? 1.0 : 0.0},
          {"count", "", double(s.touches)},
          {"force", "N", s.force.norm()},
          {"force.x", "N", s.force.x()},
          {"force.y", "N", s.force.y()},
          {"force.z", "N", s.force.z()}};
}

}  // namespace tumble
