#include "engine/world/courses.hpp"
#include "engine/world/definition_bytes.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/state.hpp"

#include <set>

// A snapshot is a sequence of named, versioned sections. Constants of bodies (mass, shapes) are
// rebuilt from their definitions, which is a pure function; motion, contacts and ids are stored.
namespace tumble {
namespace {

/// 2: gravity that follows a course.
constexpr uint32_t version = 2;
/// 2: closest features of polyhedra. 3: cached results of the narrow phase. 4: by shape instead of
/// body. 5: rolling and torsional friction. 6: no patch radius for torsion. 7: by body where a body
/// with several shapes is paired as a whole.
constexpr uint32_t contacts_version = 7;
/// 3: how they collide. 4: their life, where they are from, glow, charge, periodic boxes.
/// 5: fluids and grains. 6: looks, densities of fluids. 7: sub-steps of grains. 8: mass at birth,
/// trails.
constexpr uint32_t particles_version = 8;
constexpr uint32_t grain_touches_version = 3;
/// 2: numbers that follow courses.
constexpr uint32_t forces_version = 2;
/// 2: radial distributions.
constexpr uint32_t sensors_version = 2;
/// 2: opacity over life. 3: bodies as in version 7. 4: as in version 8. 5: as in version 9.
/// 6: values over time, mass over life; when bodies were born, what they touch, births asked for.
constexpr uint32_t emitters_version = 6;
/// 2: what acts along coordinates, their values. 3: what couples coordinates; courses of motors.
/// 4: impulses over the last tick.
constexpr uint32_t joints_version = 4;
constexpr uint32_t particle_contacts_version = 2;
/// 2: particles in contact. 3: time-stepped ticks of bodies. 4: of particles.
constexpr uint32_t event_version = 4;
/// 2: inertia and group. 3: `precise`; shapes store only the parameters that they use. 4: opacity
/// of looks; rolling and torsional friction of materials. 5: mean velocities. 6: friction with
/// fluids. 7: courses; full inertia tensors, centres of mass, shapes that are only drawn. 8: meshes
/// that shapes approximate. 9: whether a material defines rolling and torsional friction.
constexpr uint32_t bodies_version = 9;
/// 2: the line `offset`. 3: emission and removal. 4: fluids. 5: motors of joints.
constexpr uint32_t ledger_version = 5;
/// 2: ids of joints. 3: how particles collide. 4: inertia and group of bodies. 5: whether they are
/// solved precisely; shapes have the numbers that they use. 6: opacity of looks; rolling and
/// torsional friction. 7: settings without damping of what is nearly at rest. 8: emitters and
/// sinks, life and glow of particles. 9: fluids and grains. 10: looks of particles.
/// 11: friction of bodies with fluids. 12: what acts along coordinates of joints, breaking.
/// 13: what couples coordinates; courses of motors and bodies; bodies as in version 7 of theirs.
/// 14: sensors. 15: sub-steps of grains; bodies as in version 8 of theirs. 16: other definitions
/// for particles and emitters that there are. 17: bodies as in version 9 of theirs.
/// 18: emitters as in version 6 of theirs; spins of particles; sensors as in version 2; trails.
/// 19: forces as in version 2 of theirs. 20: gravity that follows a course.
constexpr uint32_t queue_version = 20;

void write_geometry(ByteWriter& out, const WorldState& s, bool with_geometry) {
  std::set<uint64_t> keys;
  const auto collect = [&](const BodyDef& def) {
    for (const BodyShapeDef& shape : def.shapes)
      for (const auto& mesh : {shape.shape.mesh, shape.source ? shape.source->mesh : nullptr})
        if (mesh) keys.insert(s.shapes->add_mesh(mesh));
    for (const DrawnShapeDef& shape : def.drawn)
      if (shape.shape.mesh) keys.insert(s.shapes->add_mesh(shape.shape.mesh));
  };
  const auto collect_emitter = [&](const EmitterDef& def) {
    if (def.body) collect(*def.body);
    if (const auto mesh = mesh_of(def.shape)) keys.insert(s.shapes->add_mesh(mesh));
  };
  if (with_geometry) {
    for (const auto& def : s.body_defs)
      if (def) collect(*def);
    for (const Emitter& e : s.emitters.list)
      if (e.def) collect_emitter(*e.def);
    for (const Command& c : s.queue) {
      if (const auto* create = std::get_if<CreateBody>(&c)) collect(create->def);
      if (const auto* set = std::get_if<SetBody>(&c)) collect(set->def);
      if (const auto* create = std::get_if<CreateEmitter>(&c)) collect_emitter(create->def);
      if (const auto* set = std::get_if<SetEmitter>(&c)) collect_emitter(set->def);
    }
  }
  out.begin_section("geometry", version);
  out.value(uint64_t(keys.size()));
  for (const uint64_t key : keys) write_mesh(out, *s.shapes->mesh(key));
  out.end_section();
}

void read_geometry(ByteReader& in, ShapeStore& shapes) {
  in.begin_section("geometry");
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    auto mesh = std::make_shared<const TriangleMesh>(read_mesh(in));
    if (in.ok()) shapes.add_mesh(mesh);
  }
  in.end_section();
}

void write_bodies(ByteWriter& out, const WorldState& s) {
  out.begin_section("bodies", bodies_version);
  s.bodies.ids.save(out);
  for (uint32_t i = 0; i < s.bodies.ids.capacity(); ++i) {
    if (!s.bodies.ids.alive(i)) continue;
    const RigidBody& b = s.bodies.bodies[i];
    write_body_def(out, *s.body_defs[i], *s.shapes);
    out.value(b.pose.x);
    out.value(b.pose.q.coeffs());
    out.value(b.v);
    out.value(b.omega);
    out.value(b.rest.v);
    out.value(b.rest.omega);
    out.value(b.rest.time);
    out.value(uint8_t{b.asleep});
  }
  out.end_section();
}

Status read_bodies(ByteReader& in, WorldState& s) {
  if (in.begin_section("bodies") != bodies_version) {
    in.fail();
    return {};
  }
  if (!s.bodies.ids.load(in)) return {};
  const uint32_t slots = s.bodies.ids.capacity();
  s.bodies.bodies.assign(slots, RigidBody{});
  s.body_defs.assign(slots, nullptr);
  for (uint32_t i = 0; i < slots && in.ok(); ++i) {
    RigidBody& b = s.bodies.bodies[i];
    b.type = BodyType::fixed;
    if (!s.bodies.ids.alive(i)) continue;
    auto def = std::make_shared<const BodyDef>(read_body_def(in, *s.shapes));
    if (!in.ok()) break;
    auto made = make_body(*def, s.shape_factory());
    if (!made) return made.error();
    b = std::move(*made);
    s.body_defs[i] = std::move(def);
    in.value(b.pose.x);
    in.value(b.pose.q.coeffs());
    in.value(b.v);
    in.value(b.omega);
    in.value(b.rest.v);
    in.value(b.rest.omega);
    in.value(b.rest.time);
    b.asleep = in.get<uint8_t>() != 0;
    b.teleported = true;
  }
  in.end_section();
  return {};
}

void write_forces(ByteWriter& out, const WorldState& s) {
  out.begin_section("forces", forces_version);
  s.force_ids.save(out);
  for (uint32_t i = 0; i < s.force_ids.capacity(); ++i)
    if (s.force_ids.alive(i)) write_force_def(out, *s.forces[i]);
  out.end_section();
}

void read_forces(ByteReader& in, WorldState& s) {
  if (in.begin_section("forces") != forces_version) return in.fail();
  s.force_ids.load(in);
  s.forces.assign(in.ok() ? s.force_ids.capacity() : 0, std::nullopt);
  for (uint32_t i = 0; i < s.forces.size() && in.ok(); ++i)
    if (s.force_ids.alive(i)) s.forces[i] = read_force_def(in);
  in.end_section();
}

void write_particles(ByteWriter& out, const WorldState& s) {
  out.begin_section("particles", particles_version);
  s.particle_ids.save(out);
  for (uint32_t i = 0; i < s.particle_ids.capacity(); ++i)
    if (s.particle_ids.alive(i)) s.particles[i].save(out);
  out.end_section();
}

void read_particles(ByteReader& in, WorldState& s) {
  if (in.begin_section("particles") != particles_version) return in.fail();
  s.particle_ids.load(in);
  s.particles.assign(in.ok() ? s.particle_ids.capacity() : 0, {});
  for (uint32_t i = 0; i < s.particles.size() && in.ok(); ++i)
    if (s.particle_ids.alive(i)) s.particles[i].load(in);
  in.end_section();
}

void write_emitters(ByteWriter& out, const WorldState& s) {
  out.begin_section("emitters", emitters_version);
  s.emitters.ids.save(out);
  for (uint32_t i = 0; i < s.emitters.ids.capacity(); ++i) {
    if (!s.emitters.ids.alive(i)) continue;
    const Emitter& e = s.emitters.list[i];
    write_emitter_def(out, *e.def, *s.shapes);
    out.value(e.begun);
    out.value(e.emitted_to);
    out.value(e.scheduled);
    out.value(e.made);
    out.value(e.alive);
    out.value(uint64_t(e.bodies.size()));
    for (const Emitter::OwnBody& b : e.bodies) {
      out.value(b.id);
      out.value(b.dies);
      out.value(b.born);
      out.vector(b.touching);
    }
    out.value(uint64_t(e.asked.size()));
    for (const Emitter::Asked& a : e.asked) {
      out.value(a.x);
      out.value(a.v);
      out.value(a.time);
      out.value(a.count);
    }
  }
  s.sinks.ids.save(out);
  for (uint32_t i = 0; i < s.sinks.ids.capacity(); ++i)
    if (s.sinks.ids.alive(i)) write_sink_def(out, s.sinks.list[i]);
  out.end_section();
}

void read_emitter(ByteReader& in, WorldState& s, Emitter& e) {
  const EmitterDef def = read_emitter_def(in, *s.shapes);
  if (!in.ok() || !validate(def)) return in.fail();
  auto made = make_emitter(def, in.get<double>());
  if (!made) return in.fail();
  e = std::move(*made);
  in.value(e.emitted_to);
  in.value(e.scheduled);
  in.value(e.made);
  in.value(e.alive);
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    Emitter::OwnBody& b = e.bodies.emplace_back();
    in.value(b.id);
    in.value(b.dies);
    in.value(b.born);
    in.vector(b.touching);
  }
  const auto asked = in.get<uint64_t>();
  for (uint64_t i = 0; i < asked && in.ok(); ++i) {
    Emitter::Asked& a = e.asked.emplace_back();
    in.value(a.x);
    in.value(a.v);
    in.value(a.time);
    in.value(a.count);
  }
}

void read_emitters(ByteReader& in, WorldState& s) {
  if (in.begin_section("emitters") != emitters_version) return in.fail();
  s.emitters.ids.load(in);
  s.emitters.list.assign(in.ok() ? s.emitters.ids.capacity() : 0, {});
  for (uint32_t i = 0; i < s.emitters.list.size() && in.ok(); ++i)
    if (s.emitters.ids.alive(i)) read_emitter(in, s, s.emitters.list[i]);
  s.sinks.ids.load(in);
  s.sinks.list.assign(in.ok() ? s.sinks.ids.capacity() : 0, {});
  for (uint32_t i = 0; i < s.sinks.list.size() && in.ok(); ++i) {
    if (!s.sinks.ids.alive(i)) continue;
    s.sinks.list[i] = read_sink_def(in);
    if (in.ok() && !validate(s.sinks.list[i])) in.fail();
  }
  in.end_section();
}

bool read_particle_contacts(ByteReader& in, WorldState& s) {
  if (in.begin_section("particle contacts") != particle_contacts_version) return false;
  s.touching_particles = load_particle_names(in);
  if (!s.particle_contacts.load(in, ~uint32_t{0})) return false;
  in.end_section();
  for (const Contact& c : s.particle_contacts.contacts())
    for (const uint32_t slot : {c.key.body_a, c.key.body_b})
      if (!known_slot(slot, s.bodies.ids.capacity(), s.touching_particles)) return false;
  return true;
}

void write_queue(ByteWriter& out, const WorldState& s) {
  out.begin_section("queue", queue_version);
  s.reserved.bodies.save(out);
  s.reserved.forces.save(out);
  s.reserved.particles.save(out);
  s.reserved.joints.save(out);
  s.reserved.emitters.save(out);
  s.reserved.sinks.save(out);
  s.reserved.sensors.save(out);
  out.value(uint64_t(s.queue.size()));
  for (const Command& c : s.queue) write_command(out, c, *s.shapes);
  out.end_section();
}

Status read_queue(ByteReader& in, WorldState& s) {
  if (in.begin_section("queue") != queue_version) {
    in.fail();
    return {};
  }
  s.reserved.bodies.load(in);
  s.reserved.forces.load(in);
  s.reserved.particles.load(in);
  s.reserved.joints.load(in);
  s.reserved.emitters.load(in);
  s.reserved.sinks.load(in);
  s.reserved.sensors.load(in);
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    auto command = read_command(in, *s.shapes);
    if (!command) return command.error();
    s.queue.push_back(std::move(*command));
  }
  in.end_section();
  return {};
}

}  // namespace

Bytes save_state(const WorldState& s, bool with_geometry) {
  ByteWriter out;
  write_geometry(out, s, with_geometry);
  out.begin_section("world", version);
  write_settings(out, s.settings);
  out.value(s.tick);
  out.value(s.clock.tick);
  out.value(s.clock.seconds);
  out.value(uint64_t(s.log.entries().size()));
  out.end_section();
  write_bodies(out, s);
  write_forces(out, s);
  out.begin_section("joints", joints_version);
  s.joints.save(out);
  out.end_section();
  write_particles(out, s);
  write_emitters(out, s);
  out.begin_section("sensors", sensors_version);
  s.sensors.save(out);
  out.end_section();
  out.begin_section("contacts", contacts_version);
  s.contacts.save(out);
  out.end_section();
  out.begin_section("particle contacts", particle_contacts_version);
  save(out, s.touching_particles);
  s.particle_contacts.save(out);
  out.end_section();
  out.begin_section("grain touches", grain_touches_version);
  s.grain_touches.save(out);
  out.end_section();
  out.begin_section("ledger", ledger_version);
  s.ledger.save(out);
  out.end_section();
  out.begin_section("event", event_version);
  s.event.save(out);
  out.end_section();
  write_queue(out, s);
  return out.take();
}

Result<uint64_t> load_state(WorldState& target, std::span<const std::byte> snapshot) {
  const Error damaged{ErrorCode::parse,
                      "the snapshot is damaged, or names geometry that is not there",
                      "snapshot",
                      {}};
  WorldState s;
  s.shapes = target.shapes;
  ByteReader in(snapshot);
  read_geometry(in, *s.shapes);
  if (in.begin_section("world") != version) return damaged;
  s.settings = read_settings(in);
  in.value(s.tick);
  in.value(s.clock.tick);
  in.value(s.clock.seconds);
  const auto logged = in.get<uint64_t>();
  in.end_section();
  if (!in.ok()) return damaged;
  if (Status status = validate(s.settings); !status) return status.error();
  if (Status status = read_bodies(in, s); !status) return status.error();
  read_forces(in, s);
  if (in.begin_section("joints") != joints_version) return damaged;
  s.joints.load(in, s.bodies);
  in.end_section();
  read_particles(in, s);
  read_emitters(in, s);
  if (in.begin_section("sensors") != sensors_version) return damaged;
  s.sensors.load(in);
  in.end_section();
  if (in.begin_section("contacts") != contacts_version ||
      !s.contacts.load(in, s.bodies.ids.capacity()))
    return damaged;
  in.end_section();
  if (!read_particle_contacts(in, s)) return damaged;
  if (in.begin_section("grain touches") != grain_touches_version) return damaged;
  s.grain_touches.load(in);
  in.end_section();
  if (in.begin_section("ledger") != ledger_version) return damaged;
  s.ledger.load(in);
  in.end_section();
  if (in.begin_section("event") != event_version || !s.event.load(in, s.bodies.ids.capacity()))
    return damaged;
  in.end_section();
  if (Status status = read_queue(in, s); !status) return status.error();
  if (!in.ok()) return damaged;
  if (Status status = choose_algorithms(target, s.settings); !status) return status.error();

  target.settings = std::move(s.settings);
  target.tick = s.tick;
  target.clock = s.clock;
  target.bodies = std::move(s.bodies);
  target.body_defs = std::move(s.body_defs);
  target.force_ids = std::move(s.force_ids);
  target.forces = std::move(s.forces);
  target.joints = std::move(s.joints);
  target.particle_ids = std::move(s.particle_ids);
  target.particles = std::move(s.particles);
  target.emitters = std::move(s.emitters);
  target.sinks = std::move(s.sinks);
  target.sensors = std::move(s.sensors);
  target.contacts = std::move(s.contacts);
  target.particle_contacts = std::move(s.particle_contacts);
  target.touching_particles = std::move(s.touching_particles);
  target.grain_touches = std::move(s.grain_touches);
  target.ledger = std::move(s.ledger);
  target.event.contacts = std::move(s.event.contacts);
  target.event.particles = std::move(s.event.particles);
  target.event.time_stepped = std::move(s.event.time_stepped);
  target.event.time_stepped_particles = std::move(s.event.time_stepped_particles);
  target.reserved = std::move(s.reserved);
  target.queue = std::move(s.queue);
  target.islands = {};
  target.particle_detection.clear();
  target.stats = {};
  target.laid_asleep = true;
  find_courses(target);
  target.frames.infos_changed = true;
  target.frames.chunks_changed.assign(target.frames.chunks_changed.size(), 1);
  target.still = false;
  target.forget_bodies();
  reserve_for_emitters(target);
  measure(target);
  target.frames.due = FrameState::Due::make;
  return logged;
}

}  // namespace tumble
