#include "engine/scene/build/live_parts.hpp"

#include "engine/dynamics/particles/emission_bounds.hpp"
#include "engine/scene/build/emitter_defs.hpp"
#include "engine/scene/build/fluid_start.hpp"
#include "engine/scene/build/force_defs.hpp"
#include "engine/scene/build/sensor_defs.hpp"
#include "engine/scene/build/weave_defs.hpp"
#include "engine/scene/visitors/object_validator.hpp"

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

/// Calls f for the four lists of parts with their keys.
template <class Scene, class F>
void for_lists(Scene& s, const F& f) {
  f("emitters", s.emitters);
  f("sensors", s.sensors);
  f("forces", s.forces);
  f("particles", s.particles);
}

/// What the functions that build a scene ask for of a world that somebody else owns: lent, and
/// given back.
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

/// The first thing that is wrong with a description by itself.
Status checked(const std::string& name, const PartDescription& part) {
  std::optional<Error> first;
  const FaultSink sink = [&](std::string path, std::string message) {
    if (!first) first = Error{ErrorCode::invalid_argument, std::move(message), std::move(path), {}};
  };
  std::visit(
      [&](const auto& d) {
        ObjectValidator(sink, {}).visit(d, fmt::format("{}.{}", list_of(part), name));
      },
      part);
  if (first) return *std::move(first);
  return {};
}

bool holds_on_to(const ForceDef& def, ParticleSystemId id) {
  const auto is_of = [&](const Anchor& a) {
    return a.kind == Anchor::Kind::particle && a.particles == id;
  };
  if (const auto* spring = std::get_if<SpringDef>(&def))
    return is_of(spring->a) || is_of(spring->b);
  const auto* mesh = std::get_if<SpringMeshDef>(&def);
  return mesh && mesh->mesh && std::ranges::any_of(mesh->mesh->nodes, is_of);
}

/// What an emitter makes copies of: a body of now, as if it had been described for that.
std::shared_ptr<const BodyDef> template_of(const World& world, const std::string& name) {
  auto def = world.body_def(world.find_body(name));
  if (!def) return nullptr;
  def->type = BodyType::dynamic;
  def->course = nullptr;
  def->starts_asleep = false;
  return std::make_shared<const BodyDef>(*std::move(def));
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

LiveParts::LiveParts(const BuiltScene& built) {
  for (const auto& [name, id] : built.emitters) emitters_[name].push_back(id);
  for (const auto& [name, id] : built.forces) forces_[name].push_back(id);
}

void LiveParts::know(const std::string& name, ForceId id) {
  std::vector<ForceId>& known = forces_[name];
  if (std::ranges::find(known, id) == known.end()) known.push_back(id);
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
                      const PartDescription& part) {
  if (Status ok = checked(name, part); !ok) return ok;
  const Moment before = world.moment();
  Status done;
  if (const auto* emitter = std::get_if<EmitterDescription>(&part))
    done = set_emitter(world, parts, name, *emitter);
  else if (const auto* sensor = std::get_if<SensorDescription>(&part))
    done = set_sensor(world, name, *sensor);
  else if (const auto* force = std::get_if<ForceDescription>(&part))
    done = set_force(world, name, *force);
  else
    done = set_particles(world, parts, name, std::get<ParticleSystemDescription>(part));
  if (done) done = world.apply_commands();
  if (!done) (void)world.restore(before);
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
    // One that is only there to be copied is known from before.
    if (!body && old) body = old->def->body;
    if (!body) return missing("body", d.body);
  }
  std::vector<std::string> warnings;
  const SceneMeshes no_meshes(
      SceneDescription{}, [](std::string, std::string) {}, warnings);
  auto def = emitter_def(parts, name, d, *lent, no_meshes, body);
  if (!def) return def.error();
  const bool of_mesh = std::holds_alternative<MeshSurfaceEmission>(def->shape) ||
                       std::holds_alternative<MeshVolumeEmission>(def->shape);
  if (of_mesh && old && old->def->shape.index() == def->shape.index()) def->shape = old->def->shape;
  if (Status ok = validate(*def); !ok) return ok;
  const NamedEmitter alone[] = {{old_id, &*def}};
  const double most = most_alive(alone, world.settings().tick.tick())[0];
  if (d.events.empty() && !(most <= (def->body ? max_copies : max_particles)))
    return Error{ErrorCode::invalid_argument, "nothing bounds how many of its there may be at once",
                 "emitters." + name,
                 "a lower rate, a shorter life, an end, a count or at_most makes fewer"};
  if (old)
    if (Status gone = world.destroy_emitter(old_id); !gone) return gone;
  const auto id = world.create_emitter(*std::move(def));
  if (!id) return id.error();
  emitters_[name].push_back(*id);
  // Emitters whose events call the old one call the new one.
  for (const auto& [caller, by] : parts.emitters.items)
    if (caller != name && std::ranges::any_of(by.events, [&](const EmitterEventDescription& e) {
          return e.emitter == name;
        }))
      if (Status done = set_emitter(world, parts, caller, by); !done) return done;
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
                                const std::string& name, const ParticleSystemDescription& d) {
  std::vector<WaitingWeave> weaves;
  Result<ParticleSystemDef> def = particle_def(parts, name, d, max_particles);
  if (!def) return def.error();
  {
    LentWorld lent(world);
    auto woven = add_weaves(name, d, max_particles, *lent, *def);
    if (!woven) return woven.error();
    weaves = *std::move(woven);
    std::vector<std::string> warnings;
    if (def->fluid) fit_fluid(world, lent->bodies, *def, warnings);
  }
  if (Status ok = validate(*def); !ok) return ok;
  (void)remove_particles(world, name);
  const auto id = world.create_particles(*std::move(def));
  if (!id) return id.error();
  if (Status done = world.apply_commands(); !done) return done;
  if (d.springs) {
    const auto springs = neighbour_springs(*d.springs, *id, *world.particles(*id));
    if (!springs) return springs.error();
    for (const SpringDef& spring : *springs)
      if (const auto made = world.create_force(spring); !made) return made.error();
  }
  for (WaitingWeave& w : weaves) {
    SpringMeshDef mesh = tie(std::move(w.weave), *id, w.first);
    mesh.break_strain = w.break_strain;
    if (const auto made = world.create_force(std::move(mesh)); !made) return made.error();
  }
  if (Status done = world.apply_commands(); !done) return done;
  // Who filled the old one fills the new one.
  for (const auto& [emitter_name, emitter_d] : parts.emitters.items)
    if (emitter_d.particles == name)
      if (Status done = set_emitter(world, parts, emitter_name, emitter_d); !done) return done;
  return {};
}

bool LiveParts::remove_particles(World& world, const std::string& name) {
  const auto frame = world.frame();
  for (const auto& system : frame->particles) {
    if (!system || system->name != name) continue;
    for (const ForceFrame& force : frame->forces)
      if (holds_on_to(force.def, system->id)) (void)world.destroy_force(force.id);
    return world.destroy_particles(system->id).ok();
  }
  return false;
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
