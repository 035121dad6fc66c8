#include "engine/collision/shapes/validation.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/json_tree.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/repetition.hpp"
#include "engine/scene/visitors/object_validator.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Checks the names by which parts of a scene refer to each other.
class ReferenceCheck {
 public:
  ReferenceCheck(const SceneDescription& scene, const FaultSink& sink)
      : scene_(scene), sink_(sink) {}

  void run() {
    for (const auto& m : scene_.materials.items) material(m.value, "materials." + m.name + ".like");
    for (const auto& b : scene_.bodies.items) body(b.value, "bodies." + b.name);
    for (const auto& p : scene_.particles.items) particles(p.value, "particles." + p.name);
    for (const auto& e : scene_.emitters.items) emitter(e.value, "emitters." + e.name);
    for (const auto& s : scene_.sinks.items)
      systems(s.value.particles, "sinks." + s.name + ".particles");
    for (const auto& s : scene_.sensors.items) sensor(s.value, "sensors." + s.name);
    for (const auto& j : scene_.joints.items) joint(j.value, "joints." + j.name);
    for (const auto& r : scene_.robots.items)
      sink_("robots." + r.name, "robots are only taken in by read_scene() (write_scene() first)");
    for (const auto& f : scene_.forces.items) force(f.value, "forces." + f.name);
    for (const auto& c : scene_.cameras.items)
      if (!c.value.follow.empty()) body_name(c.value.follow, "cameras." + c.name + ".follow");
    if (scene_.microscope) {
      const MicroscopeDescription& m = *scene_.microscope;
      if (!m.a.empty()) body_name(m.a, "microscope.a");
      if (!m.b.empty()) body_name(m.b, "microscope.b");
    }
    if (scene_.lesson) lesson(*scene_.lesson);
  }

 private:
  void material(const MaterialDescription& m, const std::string& path) {
    const auto resolved = resolve_material(m, scene_.materials);
    if (!resolved) sink_(path, resolved.error().message);
  }
  void material(const std::optional<MaterialDescription>& m, const std::string& path) {
    if (m) material(*m, path);
  }
  void mesh(const std::string& name, const std::string& path) {
    if (!name.empty() && !scene_.meshes.find(name))
      sink_(path, unknown_name("mesh", name, scene_.meshes.names()));
  }
  void shape(const ShapeDescription& s, const std::string& path) {
    material(s.material, path + ".material");
    meshes_of(s, path);
  }
  void meshes_of(const auto& s, const std::string& path) {
    if (const auto* hull = std::get_if<ConvexHullShapeDescription>(&s.kind))
      mesh(hull->mesh, path + ".mesh");
    if (const auto* m = std::get_if<TriangleMeshShapeDescription>(&s.kind))
      mesh(m->mesh, path + ".mesh");
    if (const auto* m = std::get_if<MeshShapeDescription>(&s.kind)) mesh(m->mesh, path + ".mesh");
  }
  void body(const BodyDescription& b, const std::string& path) {
    material(b.material, path + ".material");
    if (b.shape) shape(*b.shape, path + ".shape");
    for (size_t i = 0; i < b.shapes.size(); ++i)
      shape(b.shapes[i], path + ".shapes[" + std::to_string(i) + "]");
    for (size_t i = 0; i < b.drawn.size(); ++i)
      meshes_of(b.drawn[i], path + ".drawn[" + std::to_string(i) + "]");
    const double copies = copy_count(b);
    total_ += copies;
    if (copies > max_copies) {
      // A single count beyond the limit has been reported as out of range.
      const RepetitionKind& first = b.repeat[0].kind;
      if (b.repeat.size() > 1 || std::holds_alternative<GridRepetition>(first) ||
          std::holds_alternative<PointsRepetition>(first))
        sink_(path + ".repeat",
              fmt::format("makes {:.6g} copies; at most {:.0f} are allowed", copies, max_copies));
    } else if (total_ > max_copies && !too_many_) {
      too_many_ = true;
      sink_(path + ".repeat", fmt::format("the scene has more than {:.0f} bodies", max_copies));
    }
    for (const auto& copy : b.copies.items) {
      const std::string at = path + ".copies." + copy.name;
      material(copy.value.material, at + ".material");
      double index = 0;
      const char* end = copy.name.data() + copy.name.size();
      std::from_chars(copy.name.data(), end, index);
      if (index >= copies)
        sink_(at, fmt::format("there is no copy {}: the copies are 0 to {:.0f}", copy.name,
                              copies - 1));
    }
  }
  /// Checks radii like those of shapes, since particles collide as balls.
  void particles(const ParticleSystemDescription& p, const std::string& path) {
    const auto check = [this](double radius, const std::string& at) {
      if (radius > 0 && radius < min_shape_size)
        sink_(at, fmt::format("must be at least {} m, got {} m", min_shape_size, radius));
    };
    check(p.radius, path + ".radius");
    for (size_t i = 0; i < p.list.size(); ++i)
      if (p.list[i].radius) check(*p.list[i].radius, fmt::format("{}.list[{}].radius", path, i));
    weaves(p, path);
  }
  /// Checks a name such as "ball" or "brick[3]".
  void body_name(const std::string& name, const std::string& path) {
    const size_t bracket = name.find('[');
    const std::string base = name.substr(0, bracket);
    const BodyDescription* b = scene_.bodies.find(base);
    if (!b) return sink_(path, unknown_name("body", base, scene_.bodies.names()));
    const bool repeated = !b->repeat.empty();
    if (bracket == std::string::npos) {
      if (repeated)
        sink_(path,
              fmt::format("'{0}' has {1:.0f} copies; say which: \"{0}[0]\"", base, copy_count(*b)));
      return;
    }
    double index = -1;
    const char* end = name.data() + name.size();
    const auto [stop, bad] = std::from_chars(name.data() + bracket + 1, end, index);
    if (bad != std::errc{} || stop + 1 != end || *stop != ']' || index < 0)
      return sink_(path, "'" + name + "' is not of the form name[number]");
    if (!repeated) return sink_(path, "'" + base + "' is a single body, without copies");
    if (index >= copy_count(*b))
      sink_(path, fmt::format("there is no copy {:.0f}: the copies are 0 to {:.0f}", index,
                              copy_count(*b) - 1));
  }
  void system(const std::string& name, const std::string& path) {
    if (!scene_.particles.find(name))
      sink_(path, unknown_name("particle system", name, scene_.particles.names()));
  }
  void systems(const std::vector<std::string>& names, const std::string& path) {
    for (size_t i = 0; i < names.size(); ++i) system(names[i], fmt::format("{}[{}]", path, i));
  }
  void emitter(const EmitterDescription& e, const std::string& path) {
    if (!e.particles.empty()) system(e.particles, path + ".particles");
    if (!e.body.empty() && !scene_.bodies.find(e.body)) body_name(e.body, path + ".body");
    if (!e.carrier.empty()) body_name(e.carrier, path + ".carrier");
    if (e.shape)
      std::visit(
          [&](const auto& kind) {
            if constexpr (requires { kind.mesh; }) mesh(kind.mesh, path + ".shape.mesh");
          },
          e.shape->kind);
    if (e.radius) {
      double least = e.radius->number.least();
      for (const double f : e.size_over_life) least = std::min(least, f * e.radius->number.least());
      for (const EmissionKeyDescription& key : e.over_time)
        least = std::min(least, key.radius.value_or(1) * e.radius->number.least());
      if (least > 0 && least < min_shape_size)
        sink_(path + ".radius",
              fmt::format("must be at least {} m, but may be {} m", min_shape_size, least));
    }
    const ParticleSystemDescription* of = scene_.particles.find(e.particles);
    if (of && !of->grains && (e.spin.number.mean != 0 || e.spin.number.spread != 0))
      sink_(path + ".spin", fmt::format("the particles of '{0}' do not turn: only bodies do, and "
                                        "particles with \"grains\" in particles.{0}",
                                        e.particles));
    for (size_t i = 0; i < e.events.size(); ++i) event(e, i, path);
  }
  void event(const EmitterDescription& e, size_t i, const std::string& path) {
    const EmitterEventDescription& event = e.events[i];
    const std::string at = fmt::format("{}.events[{}]", path, i);
    if (!event.emitter.empty() && !scene_.emitters.find(event.emitter))
      sink_(at + ".emitter", unknown_name("emitter", event.emitter, scene_.emitters.names()));
    const ParticleSystemDescription* p = scene_.particles.find(e.particles);
    if (event.event == SpawnRule::On::collision && p && !p->detect && !p->fast)
      sink_(at + ".event",
            fmt::format("collisions of '{0}' are not looked for: set detect, or fast, to true in "
                        "particles.{0}",
                        e.particles));
  }
  void couple(const DriveDescription& d, const std::string& path) {
    if (!d.couple || d.couple->joint.empty()) return;
    const std::string base = d.couple->joint.substr(0, d.couple->joint.find('['));
    if (!scene_.joints.find(base))
      sink_(path + ".couple.joint", unknown_name("joint", base, scene_.joints.names()));
  }
  /// Checks the ends of a joint, for the first and the last copy if it has several.
  void joint(const JointDescription& j, const std::string& path) {
    couple(j.drive, path);
    JointDescription::for_drives(j, [&](const std::string& name, const auto& drive) {
      if (drive) couple(*drive, path + "." + name);
    });
    if (j.count > max_copies) return;  // reported as out of range
    if (!j.a.empty() && j.a == j.b) sink_(path + ".b", "a and b are the same body");
    counted_body(j.a, j.count, path + ".a");
    counted_body(j.b, j.count, path + ".b");
  }
  /// Checks a body's name whose brackets may contain an expression in i = 0 .. count - 1.
  void counted_body(const std::string& name, int count, const std::string& path) {
    if (name.empty()) return;
    if (count == 1 || !scene_.bodies.find(name.substr(0, name.find('['))))
      return body_name(name, path);
    for (const int i : {0, count - 1}) {
      const auto counted = counted_name(name, i);
      if (counted)
        body_name(*counted, path);
      else
        sink_(path, counted.error().message);
    }
  }
  void sensor(const SensorDescription& s, const std::string& path) {
    if (s.count > max_copies) return;  // reported as out of range
    std::visit(
        [&](const auto& kind) {
          if constexpr (requires { kind.target; }) {
            counted_body(kind.target.body, s.count, path + ".body");
            for (size_t i = 0; i < kind.target.bodies.size(); ++i)
              body_or_copies(kind.target.bodies[i], fmt::format("{}.bodies[{}]", path, i));
            systems(kind.target.particles, path + ".particles");
          } else if constexpr (requires { kind.shells; }) {
            radial(kind, path);
          } else {
            counted_body(kind.a, s.count, path + ".a");
            counted_body(kind.b, s.count, path + ".b");
          }
        },
        s.kind);
  }
  void radial(const RadialDescription& d, const std::string& path) {
    systems(d.particles, path + ".particles");
    std::optional<Vec3> size;  // of the box of the first; its position does not affect distances
    for (size_t i = 0; i < d.particles.size(); ++i) {
      const std::string& name = d.particles[i];
      const std::string at = fmt::format("{}.particles[{}]", path, i);
      const auto before = d.particles.begin() + ptrdiff_t(i);
      if (std::find(d.particles.begin(), before, name) != before)
        return sink_(at, "'" + name + "' is named twice");
      const ParticleSystemDescription* p = scene_.particles.find(name);
      if (!p) continue;
      const Vec3 own = p->periodic_box ? p->periodic_box->size : Vec3(Vec3::Zero());
      if (size && *size != own)
        return sink_(at, "its periodic box is of another size than that of '" + d.particles[0] +
                             "', so that distances between their particles mean nothing");
      size = own;
      if (!p->periodic_box) continue;
      for (int k = 0; k < 3; ++k)
        if (const double edge = p->periodic_box->size[k]; edge > 0 && d.range > 0.5 * edge)
          return sink_(
              path + ".range",
              fmt::format("must be at most half an edge of the periodic box, {} m", 0.5 * edge));
    }
  }
  void lesson(const LessonDescription& l) {
    for (size_t i = 0; i < l.steps.size(); ++i)
      if (const std::string& camera = l.steps[i].camera;
          !camera.empty() && !scene_.cameras.find(camera))
        sink_(fmt::format("lesson.steps[{}].camera", i),
              unknown_name("camera", camera, scene_.cameras.names()));
  }
  void anchor(const AnchorDescription& a, const std::string& path) {
    if (!a.body.empty()) body_name(a.body, path + ".body");
    if (!a.particles.empty() && !scene_.particles.find(a.particles))
      sink_(path + ".particles",
            unknown_name("particle system", a.particles, scene_.particles.names()));
  }
  /// Checks the name of a body; that of a body with copies stands for all of them.
  void body_or_copies(const std::string& name, const std::string& path) {
    if (!name.empty() && !scene_.bodies.find(name)) body_name(name, path);
  }
  void weaves(const ParticleSystemDescription& p, const std::string& path) {
    const auto pins = [&](const auto& list, const std::string& key) {
      for (size_t i = 0; i < list.size(); ++i)
        for (size_t k = 0; k < list[i].sheet.pins.size(); ++k) {
          const PinDescription& pin = list[i].sheet.pins[k];
          const std::string at = fmt::format("{}.{}[{}].pins[{}]", path, key, i, k);
          if (!pin.body.empty()) body_name(pin.body, at + ".body");
          if (pin.row >= list[i].sheet.rows || pin.column >= list[i].sheet.columns)
            sink_(at, fmt::format("there is no node in row {}, column {}: rows and columns are "
                                  "counted from 0",
                                  pin.row, pin.column));
        }
    };
    pins(p.cloth, "cloth");
    pins(p.net, "net");
    for (size_t i = 0; i < p.rope.size(); ++i)
      for (size_t k = 0; k < p.rope[i].path.size(); ++k) {
        const AnchorDescription& a = p.rope[i].path[k].anchor;
        const std::string at = fmt::format("{}.rope[{}].path[{}]", path, i, k);
        body_or_copies(a.body, at + ".body");
        if (!a.particles.empty() && !scene_.particles.find(a.particles))
          sink_(at + ".particles",
                unknown_name("particle system", a.particles, scene_.particles.names()));
      }
  }
  void acted_on(const auto& field, const std::string& path) {
    for (size_t i = 0; i < field.bodies.size(); ++i) {
      const std::string& name = field.bodies[i];
      if (!scene_.bodies.find(name))  // the name also stands for its copies
        body_name(name, path + ".bodies[" + std::to_string(i) + "]");
    }
    systems(field.particles, path + ".particles");
  }
  void force(const ForceDescription& f, const std::string& path) {
    std::visit(
        [&](const auto& kind) {
          if constexpr (requires { kind.field.targets; }) acted_on(kind, path);
          if constexpr (requires { kind.between; }) systems(kind.between, path + ".between");
          if constexpr (requires { kind.anchor; }) anchor(kind.anchor, path + ".anchor");
        },
        f.kind);
    if (const auto* spring = std::get_if<SpringDescription>(&f.kind)) {
      anchor(spring->a, path + ".a");
      anchor(spring->b, path + ".b");
    }
  }

  const SceneDescription& scene_;
  const FaultSink& sink_;
  double total_ = 0;
  bool too_many_ = false;
};

}  // namespace

Fault fault_at(const SceneDescription& scene, std::string path, std::string message) {
  Fault out{{}, 0, std::move(path), std::move(message)};
  if (scene.source) {
    out.file = scene.source->file;
    if (scene.source->tree) {
      out.line = line_of(*scene.source->tree, out.path);
      if (out.line == 0) out.file = "--set";
    }
  }
  return out;
}

std::vector<Fault> validate(const SceneDescription& scene) {
  FaultList faults;
  const FaultSink sink = [&](std::string path, std::string message) {
    faults.add(fault_at(scene, std::move(path), std::move(message)));
  };
  validate_object(struct_ref(scene), {}, sink);
  ReferenceCheck(scene, sink).run();
  return faults.sorted();
}

}  // namespace tumble
