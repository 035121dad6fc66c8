#include "engine/core/stop.hpp"
#include "engine/dynamics/particles/emission_bounds.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/build/assembly.hpp"
#include "engine/scene/build/body_defs.hpp"
#include "engine/scene/build/coupling_faults.hpp"
#include "engine/scene/build/emitter_defs.hpp"
#include "engine/scene/build/emitter_overlaps.hpp"
#include "engine/scene/build/fluid_start.hpp"
#include "engine/scene/build/force_defs.hpp"
#include "engine/scene/build/joint_defs.hpp"
#include "engine/scene/build/sensor_defs.hpp"
#include "engine/scene/build/start_warnings.hpp"
#include "engine/scene/build/weave_defs.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Builds a world part by part; collects faults instead of stopping at the first.
class Builder {
 public:
  Builder(const SceneDescription& scene, FaultList& faults)
      : scene_(scene), sink_([this, &faults](std::string path, std::string message) {
          faults.add(fault_at(scene_, std::move(path), std::move(message)));
        }) {}

  void fault(std::string path, std::string message) { sink_(std::move(path), std::move(message)); }

  /// Creates a world whose warnings are collected during the build, and later only passed on.
  void create_world(WorldDef extras, std::shared_ptr<ShapeStore> shapes) {
    extras.settings = scene_.settings;
    extras.log = [caught = caught_, next = extras.log](LogLevel level, std::string_view message) {
      if (caught->open && level >= LogLevel::warning) caught->lines.emplace_back(message);
      if (next) next(level, message);
    };
    auto world = World::create(std::move(extras), std::move(shapes));
    if (!world) return fault("settings", world.error().text());
    built_.world = std::move(*world);
  }

  void read_meshes() {
    meshes_ = std::make_shared<const SceneMeshes>(scene_, sink_, built_.warnings);
    built_.meshes = meshes_;
  }

  void add_bodies() {
    for (const auto& [name, body] : scene_.bodies.items) {
      if (stop_requested()) return;
      if (!body.present) continue;
      for (BodyDef& def : body_defs(scene_, name, body, *meshes_, sink_, built_.warnings)) {
        if (stop_requested()) return;
        if (!built_.world) break;
        std::string copy = def.name;
        def.pose.q.normalize();  // formulas and angles give unit quaternions up to rounding
        const auto id = built_.world->create_body(std::move(def));
        if (!id) {
          const std::string which = copy == name ? "" : " (" + copy + ")";
          const std::string& cure = id.error().cure;
          fault("bodies." + name,
                id.error().message + which + (cure.empty() ? "" : " (" + cure + ")"));
          break;  // the other copies would have the same fault
        }
        built_.bodies.emplace(std::move(copy), *id);
      }
    }
  }

  void add_particles() {
    double& budget = particle_budget_;
    const auto order = particle_order(scene_);
    if (!order) return fault(order.error().place, order.error().message);
    for (const std::string& name : *order) {
      const ParticleSystemDescription& system = *scene_.particles.find(name);
      auto def = particle_def(scene_, name, system, budget);
      if (!def) {
        fault(def.error().place, def.error().message);
        continue;
      }
      if (!built_.world) continue;
      if (!system.cloth.empty() || !system.net.empty() || !system.rope.empty()) {
        apply();
        auto weaves = add_weaves(name, system, budget, built_, *def);
        if (!weaves) {
          fault(weaves.error().place, weaves.error().message);
          continue;
        }
        for (WaitingWeave& weave : *weaves) weaves_.push_back(std::move(weave));
      }
      budget -= double(def->particles.size());
      if (def->fluid) {
        apply();
        const Status held = fit_fluid(*built_.world, built_.bodies, *def,
                                      !scene_.sinks.items.empty(), built_.warnings);
        if (!held) {
          fault(held.error().place, held.error().message + " (" + held.error().cure + ")");
          continue;
        }
      }
      const auto id = built_.world->create_particles(std::move(*def));
      if (!id)
        fault("particles." + name, id.error().message);
      else
        built_.particles.emplace(name, *id);
    }
  }

  void add_emitters() {
    if (!built_.world) return;
    const auto order = emitter_order(scene_);
    if (!order) return fault(order.error().place, order.error().message);
    std::vector<EmitterDef> defs;
    for (const std::string& name : *order) {
      const EmitterDescription& d = *scene_.emitters.find(name);
      auto def = emitter_def(scene_, name, d, built_, *meshes_, template_of(d));
      if (!def) {
        fault("emitters." + name, def.error().message);
        continue;
      }
      const auto id = built_.world->create_emitter(*def);
      if (!id) {
        const bool of_shape = id.error().place == "emitter '" + name + "'" && d.shape;
        const std::string& cure = id.error().cure;
        fault("emitters." + name + (of_shape ? ".shape" : ""),
              id.error().message + (cure.empty() ? "" : " (" + cure + ")"));
        continue;
      }
      built_.emitters.emplace(name, *id);
      defs.push_back(std::move(*def));
    }
    if (defs.size() == order->size()) check_crowds(*order, defs);
  }

  /// Must be called after apply(), since it looks at existing emitters.
  void check_emitter_overlaps() {
    if (!built_.world) return;
    for (const EmitterOverlap& o : emitter_overlaps(built_))
      fault("emitters." + o.second,
            fmt::format("overlaps the emitter '{}' at ({:.4g}, {:.4g}, {:.4g}): what they emit "
                        "would begin in each other (place them apart, let them emit at other "
                        "times, or set \"collide\": false)",
                        o.first, o.place.x(), o.place.y(), o.place.z()));
  }

  void add_sinks() {
    if (!built_.world) return;
    for (const auto& [name, sink] : scene_.sinks.items) {
      auto def = sink_def(name, sink, built_);
      if (!def) {
        fault("sinks." + name, def.error().message);
        continue;
      }
      const auto id = built_.world->create_sink(std::move(*def));
      if (!id)
        fault("sinks." + name, id.error().message);
      else
        built_.sinks.emplace(name, *id);
    }
  }

  void add_sensors() {
    if (!built_.world) return;
    for (const auto& [name, sensor] : scene_.sensors.items) {
      auto defs = sensor_defs(name, sensor, built_);
      if (!defs) {
        fault("sensors." + name, defs.error().message);
        continue;
      }
      for (SensorDef& def : *defs) {
        std::string copy = def.name;
        const auto id = built_.world->create_sensor(std::move(def));
        if (!id) {
          fault("sensors." + name, id.error().message);
          break;
        }
        built_.sensors.emplace(std::move(copy), *id);
      }
    }
  }

  void add_joints() {
    if (!built_.world) return;
    for (const auto& [name, joint] : scene_.joints.items) {
      auto defs = joint_defs(name, joint, built_);
      if (!defs) {
        fault("joints." + name, defs.error().message);
        continue;
      }
      for (JointDef& def : *defs) {
        std::string copy = def.name;
        const auto id = built_.world->create_joint(std::move(def));
        if (!id) {
          fault("joints." + name, id.error().message);
          break;
        }
        built_.joints.emplace(std::move(copy), *id);
      }
    }
  }

  void add_couplings() {
    if (!built_.world) return;
    apply();
    for (const auto& [name, joint] : scene_.joints.items) {
      const auto coupled = couple_joints(name, joint, built_);
      if (!coupled) {
        fault("joints." + name, coupled.error().message);
        continue;
      }
      for (const auto& [id, def] : *coupled)
        if (const Status done = built_.world->set_joint(id, def); !done) {
          fault("joints." + name, done.error().message);
          break;
        }
    }
    apply();
    for (auto& [path, sentence] : coupling_faults(built_)) fault(path, std::move(sentence));
  }

  void assemble_joints() {
    if (!built_.world || !scene_.assemble) return;
    for (auto& [path, sentence] : assemble(built_)) fault(path, std::move(sentence));
    apply();
  }

  void add_forces() {
    if (!built_.world) return;
    for (const auto& [name, force] : scene_.forces.items) {
      auto def = force_def(force, built_);
      if (!def) {
        fault("forces." + name, def.error().message);
        continue;
      }
      const auto id = built_.world->create_force(std::move(*def));
      if (!id)
        fault("forces." + name, id.error().message);
      else
        built_.forces.emplace(name, *id);
    }
  }

  void tie_weaves() {
    for (WaitingWeave& w : weaves_) {
      const auto system = built_.particles.find(w.system);
      if (system == built_.particles.end()) continue;
      SpringMeshDef def = tie(std::move(w.weave), system->second, w.first);
      def.break_strain = w.break_strain;
      const auto id = built_.world->create_force(std::move(def));
      if (!id)
        fault("particles." + w.system, id.error().message);
      else
        built_.forces.emplace(w.name, *id);
    }
  }

  void add_neighbour_springs() {
    if (!built_.world) return;
    for (const auto& [name, system] : scene_.particles.items) {
      const auto it = built_.particles.find(name);
      if (!system.springs || it == built_.particles.end()) continue;
      auto springs =
          neighbour_springs(*system.springs, it->second, *built_.world->particles(it->second));
      if (!springs) {
        fault("particles." + name + ".springs", springs.error().message);
        continue;
      }
      for (size_t k = 0; k < springs->size(); ++k) {
        const auto id = built_.world->create_force((*springs)[k]);
        if (!id) return fault("particles." + name + ".springs", id.error().message);
        built_.forces.emplace(fmt::format("{}.springs[{}]", name, k), *id);
      }
    }
  }

  /// Sets up the microscope on bodies that exist by now.
  void add_microscope() {
    if (!scene_.microscope || !built_.world) return;
    const MicroscopeDescription& d = *scene_.microscope;
    MicroscopeSetup setup;
    setup.algorithm = d.algorithm;
    if (!d.a.empty() && !find_body(d.a, "microscope.a", setup.a)) return;
    if (!d.b.empty() && !find_body(d.b, "microscope.b", setup.b)) return;
    setup.step = d.step;
    setup.steps_per_second = d.steps_per_second;
    setup.span = d.span;
    setup.tolerance = d.tolerance;
    setup.beside = d.beside;
    setup.velocity = {d.velocity_a, d.velocity_b};
    setup.angular_velocity = {d.angular_velocity_a, d.angular_velocity_b};
    const std::string refusal = microscope_refusal(*built_.world->frame(), setup);
    // Contacts exist from the first tick on: an algorithm that asks the world may answer later.
    const MicroscopeEntry* entry = find_microscope(d.algorithm);
    const bool asks = entry && entry->of_world();
    if (!refusal.empty() && !asks) return fault("microscope", refusal);
    built_.microscope = setup;
  }

  /// Applies queued commands, so that forces find the bodies and the first frame is complete.
  void apply() {
    if (!built_.world) return;
    if (auto ok = built_.world->apply_commands(); !ok) fault("bodies", ok.error().text());
  }

  BuiltScene take() {
    built_.description = std::make_shared<const SceneDescription>(scene_);
    built_.warnings.insert(built_.warnings.begin(), scene_.warnings.begin(), scene_.warnings.end());
    built_.warnings.insert(built_.warnings.end(), caught_->lines.begin(), caught_->lines.end());
    caught_->open = false;
    for (std::string& line : start_warnings(built_)) built_.warnings.push_back(std::move(line));
    return std::move(built_);
  }

 private:
  /// A body that validate() knows may be a copy with "present": false.
  bool find_body(const std::string& name, std::string path, BodyId& id) {
    const auto found = built_.bodies.find(name);
    if (found == built_.bodies.end())
      fault(std::move(path), "'" + name + "' is not present");
    else
      id = found->second;
    return found != built_.bodies.end();
  }

  /// The body that an emitter copies: the first one, or the one named.
  std::shared_ptr<const BodyDef> template_of(const EmitterDescription& d) {
    const std::string base = d.body.substr(0, d.body.find('['));
    const BodyDescription* body = scene_.bodies.find(base);
    if (!body) return nullptr;
    std::vector<std::string> known_warnings;  // of its copies, which were reported before
    for (BodyDef& def : body_defs(scene_, base, *body, *meshes_, sink_, known_warnings)) {
      if (d.body != base && def.name != d.body) continue;
      def.type = BodyType::dynamic;
      def.course = nullptr;
      def.starts_asleep = false;
      return std::make_shared<const BodyDef>(std::move(def));
    }
    return nullptr;
  }

  /// Reports before the run if there may be more particles at once than a scene allows, events
  /// included.
  void check_crowds(const std::vector<std::string>& names, const std::vector<EmitterDef>& defs) {
    std::vector<NamedEmitter> emitters;
    for (size_t i = 0; i < defs.size(); ++i)
      emitters.push_back({built_.emitters.find(names[i])->second, &defs[i]});
    const std::vector<double> most = most_alive(emitters, built_.world->settings().tick.tick());
    double bodies = max_copies - double(built_.bodies.size());
    for (size_t i = 0; i < defs.size(); ++i) {
      double& room = defs[i].body ? bodies : particle_budget_;
      room -= most[i];
      if (room >= 0) continue;
      const std::string_view what = defs[i].body ? "bodies" : "particles";
      const std::string cure =
          "; a lower rate, a shorter life, an end, a count or at_most makes fewer";
      const double limit = defs[i].body ? max_copies : max_particles;
      if (std::isfinite(most[i]))
        fault("emitters." + names[i],
              fmt::format("there may be {:.6g} of its {} at once; a scene may have {:.0f} in all{}",
                          most[i], what, limit, cure));
      else
        fault("emitters." + names[i],
              fmt::format("nothing bounds how many of its {} there may be at once{}", what, cure));
      return;
    }
  }

  struct Caught {
    bool open = true;
    std::vector<std::string> lines;
  };
  const SceneDescription& scene_;
  FaultSink sink_;
  std::shared_ptr<const SceneMeshes> meshes_;
  double particle_budget_ = max_particles;  ///< how many more particles there may be
  BuiltScene built_;
  std::vector<WaitingWeave> weaves_;
  std::shared_ptr<Caught> caught_ = std::make_shared<Caught>();
};

}  // namespace

Result<BuiltScene> build_world(const SceneDescription& scene, WorldDef extras,
                               std::shared_ptr<ShapeStore> shapes, std::vector<Fault>* faults) {
  FaultList found;
  for (Fault& f : validate(scene)) found.add(std::move(f));
  const auto fail = [&]() -> Error {
    std::vector<Fault> sorted = found.sorted();
    Error error = to_error(sorted);
    if (faults) *faults = std::move(sorted);
    return error;
  };
  if (!found.empty()) return fail();
  Builder builder(scene, found);
  builder.create_world(std::move(extras), std::move(shapes));
  builder.read_meshes();
  builder.add_bodies();
  builder.apply();
  if (stop_requested()) return stopped_error();
  // Before anything is pinned or fitted to bodies, since assembly moves them.
  if (found.empty()) {
    builder.add_joints();
    builder.add_couplings();
    builder.assemble_joints();
  }
  builder.add_particles();
  builder.apply();
  if (stop_requested()) return stopped_error();
  if (!found.empty()) return fail();
  builder.add_emitters();
  builder.add_sinks();
  builder.add_sensors();
  builder.add_forces();
  builder.add_neighbour_springs();
  builder.tie_weaves();
  builder.apply();
  builder.check_emitter_overlaps();
  builder.add_microscope();
  if (stop_requested()) return stopped_error();
  if (!found.empty()) return fail();
  return builder.take();
}

}  // namespace tumble
