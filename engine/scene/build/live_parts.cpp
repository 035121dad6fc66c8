#include "engine/scene/build/live_parts.hpp"

#include "engine/dynamics/particles/emission_bounds.hpp"
#include "engine/scene/build/emitter_defs.hpp"
#include "engine/scene/build/fluid_start.hpp"
#include "engine/scene/build/force_defs.hpp"
#include "engine/scene/build/sensor_defs.hpp"
#include "engine/scene/build/weave_defs.hpp"
#include "engine/scene/visitors/object_validator.hpp"
#include "engine/scene/visitors/object_writer.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The list of a scene that holds parts of this kind.
NamedList<EmitterDescription>& list_in(SceneDescription& s, const EmitterDescription&) {
  return s.emitters;
}
NamedList<SensorDescription>& list_in(SceneDescription& s, const SensorDescription&) {
  return s.sensors;
}
NamedList<ForceDescription>& list_in(SceneDescription& s, const ForceDescription&) {
  return s.forces;
}
NamedList<ParticleSystemDescription>& list_in(SceneDescription& s,
                                              const ParticleSystemDescription&) {
  return s.particles;
}

/// Calls f for the four lists of parts and their keys.
template <class Scene, class F>
void for_lists(Scene& s, const F& f) {
  f("emitters", s.emitters);
  f("sensors", s.sensors);
  f("forces", s.forces);
  f("particles", s.particles);
}

/// Lends a world owned by somebody else to the functions that build a scene, and returns it.
class LentWorld {
 public:
  explicit LentWorld(World& world) {
    built_.world.reset(&world);
    const auto frame = world.frame();
    for (size_t slot = 0; slot < frame->body_slots(); ++slot)
      if (!frame->body(slot).id.is_null() && !frame->info(slot).name.empty())
        built_.bodies.emplace(frame->info(slot).name, frame->body(slot).id);
    for (const auto& system : frame->particles)
      if (system) built_.particles.emplace(system->name, system->id);
  }
  ~LentWorld() { (void)built_.world.release(); }
  LentWorld(const LentWorld&) = delete;
  LentWorld& operator=(const LentWorld&) = delete;

  BuiltScene& operator*() { return built_; }
  BuiltScene* operator->() { return &built_; }

 private:
  BuiltScene built_;
};

/// The first fault of a description on its own.
Status checked(const std::string& name, const PartDescription& part) {
  std::optional<Error> first;
  const FaultSink sink = [&](std::string path, std::string message) {
    if (!first) first = Error{ErrorCode::invalid_argument, std::move(message), std::move(path), {}};
  };
  std::visit(
      [&](const auto& d) {
        validate_object(struct_ref(d), fmt::format("{}.{}", list_of(part), name), sink);
      },
      part);
  if (first) return *std::move(first);
  return {};
}

bool holds_on_to(const ForceDef& def, ParticleSystemId id) {
  const auto is_of = [&](const Anchor& a) {
    return a.kind == Anchor::Kind::particle && a.particles == id;
  };
  const Anchors ends = anchors(def);
  return std::any_of(ends.begin(), ends.end(), is_of);
}

/// The template for an emitter's copies: an existing body, as if it had been described for that
/// purpose.
std::shared_ptr<const BodyDef> template_of(const World& world, const std::string& name) {
  auto def = world.body_def(world.find_body(name));
  if (!def) return nullptr;
  def->type = BodyType::dynamic;
  def->course = nullptr;
  def->starts_asleep = false;
  return std::make_shared<const BodyDef>(*std::move(def));
}

const SceneMeshes& no_meshes() {
  static std::vector<std::string> warnings;
  static const SceneMeshes none(
      SceneDescription{}, [](std::string, std::string) {}, warnings);
  return none;
}

/// Whether the scene has the mesh from which an emitter emits.
Status mesh_there(const EmitterDescription& d, const SceneMeshes* meshes) {
  if (!d.shape) return {};
  return std::visit(
      [&](const auto& kind) -> Status {
        if constexpr (requires { kind.mesh; })
          if (!meshes || !meshes->find(kind.mesh))
            return Error{ErrorCode::not_found, fmt::format("there is no mesh '{}'", kind.mesh),
                         "shape.mesh", "name one of \"meshes\" in the scene's file"};
        return {};
      },
      d.shape->kind);
}

ParticleSystemId system_named(const World& world, const std::string& name) {
  const auto frame = world.frame();
  for (const auto& system : frame->particles)
    if (system && system->name == name) return system->id;
  return {};
}

/// What a description creates in this world.
struct MadeSystem {
  ParticleSystemDef def;
  std::vector<WaitingWeave> weaves;
};

Result<MadeSystem> make_system(World& world, const SceneDescription& parts, const std::string& name,
                               const ParticleSystemDescription& d) {
  auto def = particle_def(parts, name, d, max_particles);
  if (!def) return def.error();
  LentWorld lent(world);
  auto woven = add_weaves(name, d, max_particles, *lent, *def);
  if (!woven) return woven.error();
  std::vector<std::string> warnings;
  if (def->fluid)
    if (const Status held =
            fit_fluid(world, lent->bodies, *def, !parts.sinks.items.empty(), warnings);
        !held)
      return held.error();
  return MadeSystem{*std::move(def), *std::move(woven)};
}

/// Whether the particles of both start at the same positions with the same velocities.
bool begins_alike(const ParticleSystemDef& a, const ParticleSystemDef& b) {
  return std::ranges::equal(a.particles, b.particles,
                            [](const auto& p, const auto& q) { return p.x == q.x && p.v == q.v; });
}

bool tied_alike(const ParticleSystemDescription& a, const ParticleSystemDescription& b) {
  const auto ties = [](const ParticleSystemDescription& d) {
    ParticleSystemDescription out;
    out.springs = d.springs;
    out.cloth = d.cloth;
    out.net = d.net;
    out.rope = d.rope;
    return write_all(out);
  };
  return ties(a) == ties(b);
}

/// Creates the springs and weaves of a system that now exists in the world.
Status tie_system(World& world, const ParticleSystemDescription& d, ParticleSystemId id,
                  std::vector<WaitingWeave> weaves) {
  if (d.springs) {
    const auto springs = neighbour_springs(*d.springs, id, *world.particles(id));
    if (!springs) return springs.error();
    for (const SpringDef& spring : *springs)
      if (const auto made = world.create_force(spring); !made) return made.error();
  }
  for (WaitingWeave& w : weaves) {
    SpringMeshDef mesh = tie(std::move(w.weave), id, w.first);
    mesh.break_strain = w.break_strain;
    if (const auto made = world.create_force(std::move(mesh)); !made) return made.error();
  }
  return {};
}

/// Whether a force is attached to a particle of the system with this name.
bool holds_particle_of(const ForceDescription& d, const std::string& system) {
  if (const auto* spring = std::get_if<SpringDescription>(&d.kind))
    return spring->a.particles == system || spring->b.particles == system;
  return std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.anchor; }) return kind.anchor.particles == system;
        return false;
      },
      d.kind);
}

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

template <class T>
Status missing(const T& what, const std::string& name) {
  return Error{ErrorCode::not_found, fmt::format("there is no {} '{}'", what, name), {}, {}};
}

}  // namespace

SceneDescription parts_of(const SceneDescription& scene) {
  SceneDescription out;
  out.seed = scene.seed;
  out.emitters = scene.emitters;
  out.sensors = scene.sensors;
  out.forces = scene.forces;
  out.particles = scene.particles;
  return out;
}

std::optional<PartDescription> find_part(const SceneDescription& parts, std::string_view list,
                                         std::string_view name) {
  std::optional<PartDescription> out;
  for_lists(parts, [&](std::string_view key, const auto& items) {
    if (key != list) return;
    if (const auto* found = items.find(name)) out = *found;
  });
  return out;
}

void put_part(SceneDescription& parts, const std::string& name, const PartDescription& part) {
  std::visit(
      [&](const auto& d) {
        auto& list = list_in(parts, d);
        for (auto& item : list.items)
          if (item.name == name) {
            item.value = d;
            return;
          }
        list.add(name, d);
      },
      part);
}

void drop_part(SceneDescription& parts, std::string_view list, const std::string& name) {
  for_lists(parts, [&](std::string_view key, auto& items) {
    if (key == list)
      std::erase_if(items.items, [&](const auto& item) { return item.name == name; });
  });
}

std::string new_part_name(const SceneDescription& parts, std::string_view list,
                          const std::string& base) {
  std::string name = base;
  for (int n = 2; find_part(parts, list, name); ++n) name = fmt::format("{}_{}", base, n);
  return name;
}

LiveParts::LiveParts(const BuiltScene& built) : meshes_(built.meshes) {
  for (const auto& [name, id] : built.emitters) emitters_[name].push_back(id);
  for (const auto& [name, id] : built.forces) forces_[name].push_back(id);
}

std::string LiveParts::new_force_name(const SceneDescription& parts,
                                      const std::string& base) const {
  std::string name = base;
  for (int n = 2; forces_.contains(name) || parts.forces.find(name); ++n)
    name = fmt::format("{}_{}", base, n);
  return name;
}

void LiveParts::know(const std::string& name, ForceId id) {
  std::vector<ForceId>& known = forces_[name];
  std::erase(known, id);
  known.push_back(id);  // the newest is looked up first
}

EmitterId LiveParts::emitter(const World& world, const std::string& name) const {
  const auto known = emitters_.find(name);
  if (known == emitters_.end()) return {};
  for (auto id = known->second.rbegin(); id != known->second.rend(); ++id)
    if (const Emitter* e = world.emitter(*id); e && e->def && e->def->name == name) return *id;
  return {};
}

ForceId LiveParts::force(const World& world, const std::string& name) const {
  const auto known = forces_.find(name);
  if (known == forces_.end()) return {};
  for (auto id = known->second.rbegin(); id != known->second.rend(); ++id)
    if (world.force(*id)) return *id;
  return {};
}

Status LiveParts::set(World& world, const SceneDescription& parts, const std::string& name,
                      const PartDescription& part, const PartDescription* before) {
  if (Status ok = checked(name, part); !ok) return ok;
  const Moment as_it_was = world.moment();
  Status done;
  const auto* old = before ? std::get_if<ParticleSystemDescription>(before) : nullptr;
  if (const auto* emitter = std::get_if<EmitterDescription>(&part))
    done = set_emitter(world, parts, name, *emitter);
  else if (const auto* sensor = std::get_if<SensorDescription>(&part))
    done = set_sensor(world, name, *sensor);
  else if (const auto* force = std::get_if<ForceDescription>(&part))
    done = set_force(world, name, *force);
  else
    done = set_particles(world, parts, name, std::get<ParticleSystemDescription>(part), old);
  if (done) done = world.apply_commands();
  if (!done) (void)world.restore(as_it_was);
  return done;
}

Status LiveParts::set_emitter(World& world, const SceneDescription& parts, const std::string& name,
                              const EmitterDescription& d) {
  if (const auto order = emitter_order(parts); !order) return order.error();
  LentWorld lent(world);
  for (const EmitterEventDescription& e : d.events)
    if (!e.emitter.empty()) {
      const EmitterId other = emitter(world, e.emitter);
      if (other.is_null()) return missing("emitter", e.emitter);
      lent->emitters.emplace(e.emitter, other);
    }
  const EmitterId old_id = emitter(world, name);
  const Emitter* old = old_id.is_null() ? nullptr : world.emitter(old_id);
  std::shared_ptr<const BodyDef> body;
  if (!d.body.empty()) {
    body = template_of(world, d.body);
    // A body that only serves as a template is known from before.
    if (!body && old) body = old->def->body;
    if (!body) return missing("body", d.body);
  }
  if (Status fine = mesh_there(d, meshes_.get()); !fine) return fine;
  auto def = emitter_def(parts, name, d, *lent, meshes_ ? *meshes_ : no_meshes(), body);
  if (!def) return def.error();
  if (Status ok = validate(*def); !ok) return ok;
  const NamedEmitter alone[] = {{old_id, &*def}};
  const double most = most_alive(alone, world.settings().tick.tick())[0];
  if (d.events.empty() && !(most <= (def->body ? max_copies : max_particles)))
    return Error{ErrorCode::invalid_argument, "nothing bounds how many of its there may be at once",
                 "emitters." + name,
                 "a lower rate, a shorter life, an end, a count or at_most makes fewer"};
  if (old) return world.set_emitter(old_id, *std::move(def));
  const auto id = world.create_emitter(*std::move(def));
  if (!id) return id.error();
  emitters_[name].push_back(*id);
  return {};
}

Status LiveParts::set_sensor(World& world, const std::string& name, const SensorDescription& d) {
  LentWorld lent(world);
  auto defs = sensor_defs(name, d, *lent);
  if (!defs) return defs.error();
  for (const SensorDef& def : *defs)
    if (Status ok = validate(def); !ok) return ok;
  (void)remove(world, name, d);
  for (SensorDef& def : *defs)
    if (const auto id = world.create_sensor(std::move(def)); !id) return id.error();
  return {};
}

Status LiveParts::set_force(World& world, const std::string& name, const ForceDescription& d) {
  LentWorld lent(world);
  auto def = force_def(d, *lent);
  if (!def) return def.error();
  if (const ForceId old = force(world, name); !old.is_null())
    return world.set_force(old, *std::move(def));
  const auto id = world.create_force(*std::move(def));
  if (!id) return id.error();
  forces_[name].push_back(*id);
  return {};
}

Status LiveParts::set_particles(World& world, const SceneDescription& parts,
                                const std::string& name, const ParticleSystemDescription& d,
                                const ParticleSystemDescription* before) {
  if (const auto order = particle_order(parts); !order) return order.error();
  Result<MadeSystem> made = make_system(world, parts, name, d);
  if (!made) return made.error();
  if (Status ok = validate(made->def); !ok) return ok;
  const ParticleSystemId old = system_named(world, name);
  if (!old.is_null() && before && tied_alike(*before, d)) {
    const auto was = make_system(world, parts, name, *before);
    if (was && begins_alike(was->def, made->def)) {
      if (Status done = world.set_particles(old, std::move(made->def), true); !done) return done;
      return follow_values(world, parts, name);
    }
  }
  ParticleSystemId id = old;
  if (old.is_null()) {
    const auto created = world.create_particles(std::move(made->def));
    if (!created) return created.error();
    id = *created;
  } else {
    untie(world, parts, old);
    if (Status done = world.set_particles(old, std::move(made->def)); !done) return done;
  }
  if (Status done = world.apply_commands(); !done) return done;
  if (Status done = tie_system(world, d, id, std::move(made->weaves)); !done) return done;
  return follow_particles(world, parts, name);
}

/// Updates emitters that fill a system, from which they take values.
Status LiveParts::follow_values(World& world, const SceneDescription& parts,
                                const std::string& name) {
  for (const auto& [emitter_name, d] : parts.emitters.items)
    if (d.particles == name && !emitter(world, emitter_name).is_null())
      if (Status done = set_emitter(world, parts, emitter_name, d); !done) return done;
  return {};
}

/// Updates springs at particles of a system that begins anew, and ropes of other systems.
Status LiveParts::follow_particles(World& world, const SceneDescription& parts,
                                   const std::string& name) {
  if (Status done = follow_values(world, parts, name); !done) return done;
  for (const auto& [force_name, d] : parts.forces.items)
    if (holds_particle_of(d, name) && !force(world, force_name).is_null())
      if (Status done = set_force(world, force_name, d); !done)
        return Error{done.error().code, done.error().message, "forces." + force_name, {}};
  for (const auto& [other, d] : parts.particles.items)
    if (!system_named(world, other).is_null() && among(systems_on_ropes(d), name))
      if (Status done = set_particles(world, parts, other, d, nullptr); !done) return done;
  return {};
}

/// Destroys the springs and weaves of a system's particles, except forces that the scene names.
void LiveParts::untie(World& world, const SceneDescription& parts, ParticleSystemId id) const {
  std::vector<ForceId> named;
  for (const auto& [name, d] : parts.forces.items) named.push_back(force(world, name));
  const auto frame = world.frame();
  for (const ForceFrame& force : frame->forces)
    if (holds_on_to(force.def, id) && std::ranges::find(named, force.id) == named.end())
      (void)world.destroy_force(force.id);
}

bool LiveParts::remove_particles(World& world, const std::string& name) {
  const ParticleSystemId id = system_named(world, name);
  if (id.is_null()) return false;
  untie(world, {}, id);
  return world.destroy_particles(id).ok();
}

bool LiveParts::remove(World& world, const std::string& name, const PartDescription& part) {
  bool removed = false;
  if (std::holds_alternative<EmitterDescription>(part)) {
    const EmitterId id = emitter(world, name);
    removed = !id.is_null() && world.destroy_emitter(id).ok();
  } else if (std::holds_alternative<ForceDescription>(part)) {
    const ForceId id = force(world, name);
    removed = !id.is_null() && world.destroy_force(id).ok();
  } else if (std::holds_alternative<ParticleSystemDescription>(part)) {
    removed = remove_particles(world, name);
  } else if (const auto frame = world.frame(); frame->sensors) {
    for (const SensorFrame& sensor : *frame->sensors)
      if (sensor.name == name || sensor.name.starts_with(name + "["))
        removed = world.destroy_sensor(sensor.id).ok() || removed;
  }
  return removed && world.apply_commands().ok();
}

}  // namespace tumble
