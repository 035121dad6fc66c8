#include "engine/world/definition_bytes.hpp"

#include "engine/math/time_course.hpp"
#include "engine/world/byte_parts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace tumble {

using namespace byte_parts;

namespace {

/// The mesh sources of a body's shapes, each once, in the order of the shapes.
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
    out.value(uint32_t(at - sources.begin()));  // index one beyond the last: none
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
    write_optional(out, s.material.rolling_friction);
    write_optional(out, s.material.torsional_friction);
  }
  write_sources(out, def, shapes);
  write_optional(out, def.mass);
  write_optional(out, def.inertia);
  write_optional(out, def.products);
  write_optional(out, def.centre);
  out.value(uint64_t(def.drawn.size()));
  for (const DrawnShapeDef& s : def.drawn) {
    shapes.write(out, s.shape);
    write_pose(out, s.pose);
    write_optional(out, s.colour);
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
    read_optional(in, s.material.rolling_friction);
    read_optional(in, s.material.torsional_friction);
    def.shapes.push_back(std::move(s));
  }
  read_sources(in, def, shapes);
  read_optional(in, def.mass);
  read_optional(in, def.inertia);
  read_optional(in, def.products);
  read_optional(in, def.centre);
  const auto drawn = in.get<uint64_t>();
  for (uint64_t i = 0; i < drawn && in.ok(); ++i) {
    DrawnShapeDef s;
    s.shape = shapes.read(in);
    read_pose(in, s.pose);
    read_optional(in, s.colour);
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

/// Calls read(element) for as many elements as the bytes say, while the reader is good.
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
    write_array(out, targets->bodies);
    write_array(out, targets->particles);
  }
  if (const auto* systems = paired_systems(def)) write_array(out, *systems);
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
  } else if (auto* l = std::get_if<LoadDef>(&def)) {
    read_anchor(in, l->anchor);
  } else if (auto* mesh = std::get_if<SpringMeshDef>(&def)) {
    mesh->mesh = read_spring_mesh(in);
    if (!mesh->fault().empty()) in.fail();
  } else if (FieldTargets* targets = field_targets(def)) {
    read_array(in, targets->bodies);
    read_array(in, targets->particles);
  } else if (auto* systems = paired_systems(def)) {
    read_array(in, *systems);
  }
  ReadParameters read{in};
  std::visit([&](auto& d) { std::decay_t<decltype(d)>::parameters(read, d); }, def);
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
