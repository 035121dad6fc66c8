#include "engine/scene/build/emitter_defs.hpp"

#include "engine/scene/build/named_order.hpp"
#include "engine/scene/repetition.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct ShapeMaker {
  const SceneMeshes& meshes;

  template <class Def>
  EmissionShapeDef operator()(const Def& d) const {
    return d;
  }
  template <class Emission>
  EmissionShapeDef operator()(const MeshEmissionDescription<Emission>& d) const {
    return Emission{meshes.find(d.mesh)};
  }
};

Error missing(const char* kind, const std::string& name) {
  return {ErrorCode::not_found, std::string("there is no ") + kind + " '" + name + "'", {}, {}};
}

/// Emitters that its events name; missing ones were reported before.
std::vector<std::string> called_by(const SceneDescription& scene, const std::string& name) {
  std::vector<std::string> out;
  for (const EmitterEventDescription& e : scene.emitters.find(name)->events)
    if (scene.emitters.find(e.emitter)) out.push_back(e.emitter);
  return out;
}

std::vector<Vec3f> linear(const std::vector<Colour>& colours) {
  std::vector<Vec3f> out;
  for (const Colour& c : colours) out.push_back(c.linear());
  return out;
}

/// Sets place, times and numbers.
void fill_schedule(EmitterDef& out, const EmitterDescription& d) {
  out.pose = d.placement.pose();
  out.rate = d.rate;
  out.start = d.start;
  if (d.end) out.end = *d.end;
  for (const BurstDescription& b : d.bursts) out.bursts.push_back(b.burst);
  if (d.count) out.count = uint64_t(*d.count);
  if (d.at_most) out.at_most = uint64_t(*d.at_most);
}

EmissionCourse course_of(const std::vector<EmissionKeyDescription>& keys) {
  EmissionCourse out;
  const auto add = [](auto& curve, double time, const auto& value) {
    if (value) curve.points.push_back({time, *value});
  };
  for (const EmissionKeyDescription& key : keys) {
    add(out.rate, key.time, key.rate);
    add(out.speed, key.time, key.speed);
    add(out.spread, key.time, key.spread);
    add(out.life, key.time, key.life);
    add(out.mass, key.time, key.mass);
    add(out.radius, key.time, key.radius);
    add(out.spin, key.time, key.spin);
    if (key.colour) out.colour.points.push_back({key.time, key.colour->linear()});
  }
  return out;
}

/// Sets the properties of what it emits; those not given are the values of `system`.
void fill_values(EmitterDef& out, const EmitterDescription& d,
                 const ParticleSystemDescription* system) {
  out.outward = d.direction == EmissionDirection::outward;
  out.spread = to_radians(d.spread_deg);
  out.speed = d.speed.number;
  out.inherit = d.inherit;
  out.spin = d.spin.number;
  out.any_orientation = d.random_orientation;
  if (system) {
    out.mass = {system->mass};
    out.radius = {system->radius};
    out.colours = {system->colour.linear()};
    if (system->life) out.life = {*system->life};
  }
  if (d.life) out.life = d.life->number;
  if (d.mass) out.mass = d.mass->number;
  if (d.radius) out.radius = d.radius->number;
  if (!d.colours.empty()) out.colours = linear(d.colours);
  out.size_over_life = d.size_over_life;
  out.mass_over_life = d.mass_over_life;
  out.over_time = course_of(d.over_time);
  out.colour_over_life = linear(d.colour_over_life);
  out.opacity_over_life = d.opacity_over_life;
}

}  // namespace

Result<std::vector<std::string>> emitter_order(const SceneDescription& scene) {
  NamedOrder out([&](const std::string& name) { return called_by(scene, name); });
  for (const auto& [name, emitter] : scene.emitters.items)
    if (!out.add(name))
      return Error{ErrorCode::invalid_argument,
                   "events lead from this emitter back to it, which would never end",
                   "emitters." + name,
                   {}};
  return std::move(out.order);
}

Result<EmitterDef> emitter_def(const SceneDescription& scene, const std::string& name,
                               const EmitterDescription& d, const BuiltScene& built,
                               const SceneMeshes& meshes, std::shared_ptr<const BodyDef> body) {
  EmitterDef out;
  out.name = name;
  out.body = std::move(body);
  if (!d.particles.empty()) {
    const auto it = built.particles.find(d.particles);
    if (it == built.particles.end()) return missing("particle system", d.particles);
    out.particles = it->second;
  }
  if (!d.carrier.empty()) {
    const auto it = built.bodies.find(d.carrier);
    if (it == built.bodies.end()) return missing("body", d.carrier);
    out.carrier = it->second;
  }
  if (d.shape) out.shape = std::visit(ShapeMaker{meshes}, d.shape->kind);
  fill_schedule(out, d);
  fill_values(out, d, scene.particles.find(d.particles));
  for (const EmitterEventDescription& e : d.events) {
    SpawnRule rule{e.event, {}, e.count, e.rate, e.dies};
    if (!e.emitter.empty()) {
      const auto it = built.emitters.find(e.emitter);
      if (it == built.emitters.end()) return missing("emitter", e.emitter);
      rule.emitter = it->second;
    }
    out.events.push_back(rule);
  }
  out.seed = d.seed.value_or(named_seed(scene.seed, name));
  return out;
}

Result<SinkDef> sink_def(const std::string& name, const SinkDescription& d,
                         const BuiltScene& built) {
  SinkDef out;
  out.name = name;
  out.region = d.region;
  out.pose = d.placement.pose();
  out.outside = d.outside;
  out.takes_particles = d.takes != SinkTakes::bodies;
  out.takes_bodies = d.takes != SinkTakes::particles;
  for (const std::string& system : d.particles) {
    const auto it = built.particles.find(system);
    if (it == built.particles.end()) return missing("particle system", system);
    out.systems.push_back(it->second);
  }
  return out;
}

}  // namespace tumble
