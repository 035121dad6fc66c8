#include "engine/math/time_course.hpp"
#include "engine/world/byte_parts.hpp"
#include "engine/world/definition_bytes.hpp"

#include <memory>
#include <utility>

namespace tumble {

using namespace byte_parts;

namespace {

void write_number(ByteWriter& out, const RandomNumber& n) {
  out.value(n.mean);
  out.value(n.spread);
  out.value(n.kind);
}

void read_number(ByteReader& in, RandomNumber& n) {
  in.value(n.mean);
  in.value(n.spread);
  in.value(n.kind);
  if (n.kind > RandomNumber::Kind::normal) in.fail();
}

/// Calls f for every random quantity of a definition.
template <class Def, class F>
void for_numbers(Def& def, const F& f) {
  f(def.speed);
  f(def.life);
  f(def.mass);
  f(def.radius);
  f(def.spin);
}

void write_course(ByteWriter& out, const EmissionCourse& course) {
  EmissionCourse::for_factors(course, [&out](const FactorCurve& curve) {
    out.value(uint64_t(curve.points.size()));
    for (const auto& p : curve.points) {
      out.value(p.time);
      out.value(p.value);
    }
  });
  out.value(uint64_t(course.colour.points.size()));
  for (const auto& p : course.colour.points) {
    out.value(p.time);
    out.value(p.value);
  }
}

template <class Curve>
void read_curve(ByteReader& in, Curve& curve) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    auto& p = curve.points.emplace_back();
    in.value(p.time);
    in.value(p.value);
  }
}

void read_course(ByteReader& in, EmissionCourse& course) {
  EmissionCourse::for_factors(course, [&in](FactorCurve& curve) { read_curve(in, curve); });
  read_curve(in, course.colour);
}

void write_bursts(ByteWriter& out, const std::vector<Burst>& bursts) {
  out.value(uint64_t(bursts.size()));
  for (const Burst& b : bursts) {
    out.value(b.time);
    out.value(b.count);
    out.value(b.times);
    out.value(b.every);
  }
}

void read_bursts(ByteReader& in, std::vector<Burst>& bursts) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    Burst& b = bursts.emplace_back();
    in.value(b.time);
    in.value(b.count);
    in.value(b.times);
    in.value(b.every);
  }
}

void write_rules(ByteWriter& out, const std::vector<SpawnRule>& rules) {
  out.value(uint64_t(rules.size()));
  for (const SpawnRule& r : rules) {
    out.value(r.on);
    out.value(r.emitter);
    out.value(r.count);
    out.value(r.rate);
    out.value(uint8_t{r.dies});
  }
}

void read_rules(ByteReader& in, std::vector<SpawnRule>& rules) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    SpawnRule& r = rules.emplace_back();
    in.value(r.on);
    if (r.on > SpawnRule::On::sink) in.fail();
    in.value(r.emitter);
    in.value(r.count);
    in.value(r.rate);
    r.dies = read_flag(in);
  }
}

}  // namespace

void write_emitter_def(ByteWriter& out, const EmitterDef& def, ShapeStore& shapes) {
  out.text(def.name);
  out.value(def.particles);
  out.value(uint8_t{bool(def.body)});
  if (def.body) write_body_def(out, *def.body, shapes);
  out.value(def.carrier);
  write_pose(out, def.pose);
  write_variant(out, def.shape);
  out.value(shapes.add_mesh(mesh_of(def.shape)));
  out.value(def.rate);
  out.value(def.start);
  out.value(def.end);
  write_bursts(out, def.bursts);
  out.value(def.count);
  out.value(def.at_most);
  out.value(uint8_t{def.outward});
  out.value(def.spread);
  out.value(def.inherit);
  for_numbers(def, [&out](const RandomNumber& n) { write_number(out, n); });
  write_array(out, def.colours);
  write_array(out, def.size_over_life);
  write_array(out, def.mass_over_life);
  write_array(out, def.colour_over_life);
  write_array(out, def.opacity_over_life);
  write_course(out, def.over_time);
  out.value(uint8_t{def.any_orientation});
  write_rules(out, def.events);
  out.value(def.seed);
}

EmitterDef read_emitter_def(ByteReader& in, const ShapeStore& shapes) {
  EmitterDef def;
  in.text(def.name);
  in.value(def.particles);
  if (read_flag(in)) def.body = std::make_shared<const BodyDef>(read_body_def(in, shapes));
  in.value(def.carrier);
  read_pose(in, def.pose);
  def.shape = read_variant<EmissionShapeDef>(in);
  const auto mesh = in.get<uint64_t>();
  if (auto* held = mesh_of(def.shape); held && !(*held = shapes.mesh(mesh))) in.fail();
  in.value(def.rate);
  in.value(def.start);
  in.value(def.end);
  read_bursts(in, def.bursts);
  in.value(def.count);
  in.value(def.at_most);
  def.outward = read_flag(in);
  in.value(def.spread);
  in.value(def.inherit);
  for_numbers(def, [&in](RandomNumber& n) { read_number(in, n); });
  read_array(in, def.colours);
  read_array(in, def.size_over_life);
  read_array(in, def.mass_over_life);
  read_array(in, def.colour_over_life);
  read_array(in, def.opacity_over_life);
  read_course(in, def.over_time);
  def.any_orientation = read_flag(in);
  read_rules(in, def.events);
  in.value(def.seed);
  return def;
}

void write_sink_def(ByteWriter& out, const SinkDef& def) {
  out.text(def.name);
  write_variant(out, def.region);
  write_pose(out, def.pose);
  for (const bool flag : {def.outside, def.takes_particles, def.takes_bodies})
    out.value(uint8_t(flag));
  write_array(out, def.systems);
}

SinkDef read_sink_def(ByteReader& in) {
  SinkDef def;
  in.text(def.name);
  def.region = read_variant<SinkRegion>(in);
  read_pose(in, def.pose);
  for (bool* flag : {&def.outside, &def.takes_particles, &def.takes_bodies}) *flag = read_flag(in);
  read_array(in, def.systems);
  return def;
}

void write_particles_def(ByteWriter& out, const ParticleSystemDef& def) {
  out.text(def.name);
  out.value(def.gravity_scale);
  out.value(def.friction);
  out.value(def.restitution);
  for (const bool flag : {def.collide, def.fast, def.detect, def.fluid != nullptr})
    out.value(uint8_t(flag));
  if (def.fluid) save(out, *def.fluid);
  out.value(def.charge);
  out.value(def.box.low);
  out.value(def.box.size);
  out.value(def.glow);
  save(out, def.grains);
  save(out, def.look);
  out.value(uint64_t(def.particles.size()));
  for (const ParticleDef& p : def.particles) {
    out.value(p.x);
    out.value(p.v);
    out.value(p.mass);
    out.value(p.radius);
    out.value(p.colour);
    out.value(p.life);
    out.value(p.spin);
  }
}

ParticleSystemDef read_particles_def(ByteReader& in) {
  ParticleSystemDef def;
  in.text(def.name);
  in.value(def.gravity_scale);
  in.value(def.friction);
  in.value(def.restitution);
  for (bool* flag : {&def.collide, &def.fast, &def.detect}) *flag = in.get<uint8_t>() != 0;
  if (in.get<uint8_t>() != 0) def.fluid = load_fluid(in);
  in.value(def.charge);
  in.value(def.box.low);
  in.value(def.box.size);
  in.value(def.glow);
  def.grains = load_grains(in);
  def.look = load_particle_look(in);
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    ParticleDef p;
    in.value(p.x);
    in.value(p.v);
    in.value(p.mass);
    in.value(p.radius);
    in.value(p.colour);
    in.value(p.life);
    in.value(p.spin);
    def.particles.push_back(p);
  }
  return def;
}

}  // namespace tumble
