#include "engine/world/definition_bytes.hpp"

#include "engine/math/time_course.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace tumble {
namespace {

/// Writes every declared parameter of a struct in the order of its declaration.
struct WriteParameters {
  ByteWriter& out;
  template <class T>
  void field(const T& value, const Parameter&) {
    if constexpr (std::is_same_v<T, std::string>) {
      out.text(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      out.vector(value);
    } else if constexpr (std::is_same_v<T, TickRate>) {
      out.value(value.num);
      out.value(value.den);
    } else {
      out.value(value);
    }
  }
  template <class T>
  void object(const T& value, const Parameter&) {
    T::parameters(*this, value);
  }
};

struct ReadParameters {
  ByteReader& in;
  template <class T>
  void field(T& value, const Parameter&) {
    if constexpr (std::is_same_v<T, std::string>) {
      in.text(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      in.vector(value);
    } else if constexpr (std::is_same_v<T, TickRate>) {
      in.value(value.num);
      in.value(value.den);
    } else {
      in.value(value);
    }
  }
  template <class T>
  void object(T& value, const Parameter&) {
    T::parameters(*this, value);
  }
};

void write_pose(ByteWriter& out, const Pose& pose) {
  out.value(pose.x);
  out.value(pose.q.coeffs());
}

void read_pose(ByteReader& in, Pose& pose) {
  in.value(pose.x);
  in.value(pose.q.coeffs());
}

void write_anchor(ByteWriter& out, const Anchor& a) {
  out.value(a.kind);
  out.value(a.body);
  out.value(a.particles);
  out.value(a.particle);
  out.value(a.point);
}

void read_anchor(ByteReader& in, Anchor& a) {
  in.value(a.kind);
  in.value(a.body);
  in.value(a.particles);
  in.value(a.particle);
  in.value(a.point);
  if (a.kind > Anchor::Kind::particle) in.fail();
}

template <class T>
void write_ids(ByteWriter& out, const std::vector<T>& ids) {
  out.value(uint64_t(ids.size()));
  for (const T& id : ids) out.value(id);
}

template <class T>
void read_ids(ByteReader& in, std::vector<T>& ids) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) ids.push_back(in.get<T>());
}

/// The alternative with this number, with its defaults; nothing beyond the last.
template <class Variant, size_t I = 0>
std::optional<Variant> alternative(size_t index) {
  if constexpr (I < std::variant_size_v<Variant>) {
    if (index == I) return Variant(std::in_place_index<I>);
    return alternative<Variant, I + 1>(index);
  }
  return std::nullopt;
}

/// A variant of structs that declare their parameters: its number, then those.
template <class Variant>
void write_variant(ByteWriter& out, const Variant& value) {
  out.value(uint8_t(value.index()));
  WriteParameters write{out};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(write, d); }, value);
}

template <class Variant>
Variant read_variant(ByteReader& in) {
  const auto made = alternative<Variant>(in.get<uint8_t>());
  if (!made) in.fail();
  Variant value = made.value_or(Variant{});
  ReadParameters read{in};
  std::visit([&](auto& d) { std::decay_t<decltype(d)>::parameters(read, d); }, value);
  return value;
}

bool read_flag(ByteReader& in) {
  return in.get<uint8_t>() != 0;
}

void write_optional(ByteWriter& out, const std::optional<Vec3>& value) {
  out.value(uint8_t{value.has_value()});
  out.value(value.value_or(Vec3::Zero()));
}

std::optional<Vec3> read_optional(ByteReader& in) {
  const bool given = read_flag(in);
  Vec3 value = Vec3::Zero();
  in.value(value);
  return given ? std::optional(value) : std::nullopt;
}

}  // namespace

namespace {

/// The sources of a body's shapes, each once, in the order of the shapes.
std::vector<std::shared_ptr<const MeshSource>> sources_of(const BodyDef& def) {
  std::vector<std::shared_ptr<const MeshSource>> out;
  for (const BodyShapeDef& s : def.shapes)
    if (s.source && std::find(out.begin(), out.end(), s.source) == out.end())
      out.push_back(s.source);
  return out;
}

void write_sources(ByteWriter& out, const BodyDef& def, ShapeStore& shapes) {
  const auto sources = sources_of(def);
  out.value(uint64_t(sources.size()));
  for (const auto& source : sources) {
    out.value(shapes.add_mesh(source->mesh));
    write_pose(out, source->pose);
    out.value(source->how.mode);
    out.value(source->how.concavity);
    out.value(source->how.pieces);
    out.value(source->how.cell);
  }
  for (const BodyShapeDef& s : def.shapes) {
    const auto at = std::find(sources.begin(), sources.end(), s.source);
    out.value(uint32_t(at - sources.begin()));  // one beyond the last: none
    out.value(s.filled);
  }
}

void read_sources(ByteReader& in, BodyDef& def, const ShapeStore& shapes) {
  std::vector<std::shared_ptr<const MeshSource>> sources;
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    MeshSource source;
    if (!(source.mesh = shapes.mesh(in.get<uint64_t>()))) in.fail();
    read_pose(in, source.pose);
    in.value(source.how.mode);
    if (size_t(source.how.mode) >= mesh_mode_count) in.fail();
    in.value(source.how.concavity);
    in.value(source.how.pieces);
    in.value(source.how.cell);
    sources.push_back(std::make_shared<const MeshSource>(std::move(source)));
  }
  for (BodyShapeDef& s : def.shapes) {
    const auto at = in.get<uint32_t>();
    if (at < sources.size()) s.source = sources[at];
    in.value(s.filled);
  }
}

}  // namespace

void write_body_def(ByteWriter& out, const BodyDef& def, ShapeStore& shapes) {
  out.text(def.name);
  out.value(def.type);
  write_pose(out, def.pose);
  out.value(def.velocity);
  out.value(def.angular_velocity);
  out.value(uint64_t(def.shapes.size()));
  for (const BodyShapeDef& s : def.shapes) {
    shapes.write(out, s.shape);
    write_pose(out, s.pose);
    out.value(s.material.friction);
    out.value(s.material.restitution);
    out.value(s.material.density);
    out.value(s.material.surface_velocity);
    out.value(s.material.rolling_friction);
    out.value(s.material.torsional_friction);
  }
  write_sources(out, def, shapes);
  out.value(uint8_t{def.mass.has_value()});
  out.value(def.mass.value_or(0));
  out.value(uint8_t{def.inertia.has_value()});
  out.value(def.inertia.value_or(Vec3::Zero()));
  write_optional(out, def.products);
  write_optional(out, def.centre);
  out.value(uint64_t(def.drawn.size()));
  for (const DrawnShapeDef& s : def.drawn) {
    shapes.write(out, s.shape);
    write_pose(out, s.pose);
    out.value(uint8_t{s.colour.has_value()});
    out.value(s.colour.value_or(Vec3f::Zero()));
  }
  out.value(def.group);
  out.value(def.gravity_scale);
  out.value(def.fluid_friction);
  out.value(uint8_t{def.can_sleep});
  out.value(uint8_t{def.precise});
  out.value(uint8_t{def.starts_asleep});
  out.value(uint8_t{def.hull_mass});
  out.value(uint8_t{def.course != nullptr});
  if (def.course) {
    for (const auto& x : def.course->x) write_course(out, x);
    out.value(def.course->axis);
    write_course(out, def.course->angle);
  }
  out.value(def.look.colour);
  out.value(def.look.roughness);
  out.value(def.look.metallic);
  out.value(def.look.pattern);
  out.value(def.look.opacity);
  out.value(uint8_t{def.look.visible});
}

BodyDef read_body_def(ByteReader& in, const ShapeStore& shapes) {
  BodyDef def;
  in.text(def.name);
  in.value(def.type);
  if (def.type > BodyType::dynamic) in.fail();
  read_pose(in, def.pose);
  in.value(def.velocity);
  in.value(def.angular_velocity);
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    BodyShapeDef s;
    s.shape = shapes.read(in);
    read_pose(in, s.pose);
    in.value(s.material.friction);
    in.value(s.material.restitution);
    in.value(s.material.density);
    in.value(s.material.surface_velocity);
    in.value(s.material.rolling_friction);
    in.value(s.material.torsional_friction);
    def.shapes.push_back(std::move(s));
  }
  read_sources(in, def, shapes);
  const bool has_mass = read_flag(in);
  const double mass = in.get<double>();
  if (has_mass) def.mass = mass;
  const bool has_inertia = read_flag(in);
  Vec3 inertia = Vec3::Zero();
  in.value(inertia);
  if (has_inertia) def.inertia = inertia;
  def.products = read_optional(in);
  def.centre = read_optional(in);
  const auto drawn = in.get<uint64_t>();
  for (uint64_t i = 0; i < drawn && in.ok(); ++i) {
    DrawnShapeDef s;
    s.shape = shapes.read(in);
    read_pose(in, s.pose);
    const bool coloured = read_flag(in);
    Vec3f colour = Vec3f::Zero();
    in.value(colour);
    if (coloured) s.colour = colour;
    def.drawn.push_back(std::move(s));
  }
  in.value(def.group);
  in.value(def.gravity_scale);
  in.value(def.fluid_friction);
  def.can_sleep = read_flag(in);
  def.precise = read_flag(in);
  def.starts_asleep = read_flag(in);
  def.hull_mass = read_flag(in);
  if (read_flag(in)) {
    BodyCourse course;
    for (auto& x : course.x) x = read_course(in);
    in.value(course.axis);
    course.angle = read_course(in);
    def.course = std::make_shared<const BodyCourse>(std::move(course));
  }
  in.value(def.look.colour);
  in.value(def.look.roughness);
  in.value(def.look.metallic);
  in.value(def.look.pattern);
  in.value(def.look.opacity);
  def.look.visible = read_flag(in);
  return def;
}

namespace {

void write_spring_mesh(ByteWriter& out, const SpringMesh& mesh) {
  out.value(uint64_t(mesh.nodes.size()));
  for (const Anchor& a : mesh.nodes) write_anchor(out, a);
  out.value(uint64_t(mesh.links.size()));
  for (const SpringMesh::Link& l : mesh.links) {
    for (const uint32_t node : {l.a, l.b}) out.value(node);
    for (const double x : {l.rest_length, l.stiffness, l.damping}) out.value(x);
  }
  out.value(uint64_t(mesh.bends.size()));
  for (const SpringMesh::Bend& b : mesh.bends) {
    out.value(b.count);
    for (const uint32_t node : b.node) out.value(node);
    for (const double w : b.weight) out.value(w);
    for (const double x : {b.stiffness, b.damping}) out.value(x);
  }
  out.value(uint64_t(mesh.faces.size()));
  for (const SpringMesh::Face& f : mesh.faces) {
    for (const uint32_t node : f.node) out.value(node);
    out.value(f.tone);
  }
  out.value(uint64_t(mesh.strands.size()));
  for (const SpringMesh::Strand& s : mesh.strands)
    for (const uint32_t node : {s.a, s.b}) out.value(node);
  out.value(mesh.drawing.colour);
  out.value(mesh.drawing.second_colour);
  out.value(mesh.drawing.radius);
}

/// Calls read(element) so often as the bytes say, as long as there are any.
template <class T, class Read>
void read_list(ByteReader& in, std::vector<T>& list, const Read& read) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) read(list.emplace_back());
}

std::shared_ptr<const SpringMesh> read_spring_mesh(ByteReader& in) {
  SpringMesh mesh;
  read_list(in, mesh.nodes, [&in](Anchor& a) { read_anchor(in, a); });
  read_list(in, mesh.links, [&in](SpringMesh::Link& l) {
    for (uint32_t* node : {&l.a, &l.b}) in.value(*node);
    for (double* x : {&l.rest_length, &l.stiffness, &l.damping}) in.value(*x);
  });
  read_list(in, mesh.bends, [&in](SpringMesh::Bend& b) {
    in.value(b.count);
    for (uint32_t& node : b.node) in.value(node);
    for (double& w : b.weight) in.value(w);
    for (double* x : {&b.stiffness, &b.damping}) in.value(*x);
  });
  read_list(in, mesh.faces, [&in](SpringMesh::Face& f) {
    for (uint32_t& node : f.node) in.value(node);
    in.value(f.tone);
  });
  read_list(in, mesh.strands, [&in](SpringMesh::Strand& s) {
    for (uint32_t* node : {&s.a, &s.b}) in.value(*node);
  });
  in.value(mesh.drawing.colour);
  in.value(mesh.drawing.second_colour);
  in.value(mesh.drawing.radius);
  return std::make_shared<const SpringMesh>(std::move(mesh));
}

}  // namespace

void write_force_def(ByteWriter& out, const ForceDef& def) {
  out.value(uint8_t(def.index()));
  if (const auto* m = std::get_if<SpringMeshDef>(&def))
    write_spring_mesh(out, *m->mesh);
  else
    for (const Anchor& a : anchors(def)) write_anchor(out, a);
  if (const FieldTargets* targets = field_targets(def)) {
    write_ids(out, targets->bodies);
    write_ids(out, targets->particles);
  }
  if (const auto* systems = paired_systems(def)) write_ids(out, *systems);
  WriteParameters write{out};
  std::visit([&](const auto& d) { std::decay_t<decltype(d)>::parameters(write, d); }, def);
}

ForceDef read_force_def(ByteReader& in) {
  const auto made = alternative<ForceDef>(in.get<uint8_t>());
  if (!made) in.fail();
  ForceDef def = made.value_or(ForceDef{});
  if (auto* s = std::get_if<SpringDef>(&def)) {
    read_anchor(in, s->a);
    read_anchor(in, s->b);
  } else if (auto* m = std::get_if<MouseSpringDef>(&def)) {
    read_anchor(in, m->anchor);
  } else if (auto* mesh = std::get_if<SpringMeshDef>(&def)) {
    mesh->mesh = read_spring_mesh(in);
    if (!mesh->fault().empty()) in.fail();
  } else if (FieldTargets* targets = field_targets(def)) {
    read_ids(in, targets->bodies);
    read_ids(in, targets->particles);
  } else if (auto* systems = paired_systems(def)) {
    read_ids(in, *systems);
  }
  ReadParameters read{in};
  std::visit([&](auto& d) { std::decay_t<decltype(d)>::parameters(read, d); }, def);
  return def;
}

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

/// Calls f for every number that is drawn.
template <class Def, class F>
void for_numbers(Def& def, const F& f) {
  f(def.speed);
  f(def.life);
  f(def.mass);
  f(def.radius);
  f(def.spin);
}

template <class T>
void write_array(ByteWriter& out, const std::vector<T>& values) {
  out.value(uint64_t(values.size()));
  for (const T& v : values) out.value(v);
}

template <class T>
void read_array(ByteReader& in, std::vector<T>& values) {
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) in.value(values.emplace_back());
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
    if (r.on > SpawnRule::On::collision) in.fail();
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
  write_array(out, def.colour_over_life);
  write_array(out, def.opacity_over_life);
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
  read_array(in, def.colour_over_life);
  read_array(in, def.opacity_over_life);
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
  write_ids(out, def.systems);
}

SinkDef read_sink_def(ByteReader& in) {
  SinkDef def;
  in.text(def.name);
  def.region = read_variant<SinkRegion>(in);
  read_pose(in, def.pose);
  for (bool* flag : {&def.outside, &def.takes_particles, &def.takes_bodies}) *flag = read_flag(in);
  read_ids(in, def.systems);
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
    def.particles.push_back(p);
  }
  return def;
}

void write_settings(ByteWriter& out, const WorldSettings& settings) {
  WriteParameters write{out};
  WorldSettings::parameters(write, settings);
}

WorldSettings read_settings(ByteReader& in) {
  WorldSettings settings;
  ReadParameters read{in};
  WorldSettings::parameters(read, settings);
  return settings;
}

}  // namespace tumble
