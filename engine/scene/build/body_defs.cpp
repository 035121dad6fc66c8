#include "engine/scene/build/body_defs.hpp"

#include "engine/scene/repetition.hpp"

#include <map>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Turns descriptions into definitions.
struct Maker {
  const SceneDescription& scene;
  const std::string& name;  ///< of the body
  const SceneMeshes& meshes;
  const FaultSink& sink;
  std::vector<std::string>& warnings;

  /// For a description that validate() accepted; unknown names give the default.
  Material material(const std::optional<MaterialDescription>& m) const {
    if (!m) return {};
    const auto resolved = resolve_material(*m, scene.materials);
    return resolved ? *resolved : Material{};
  }

  static ShapeDef of_type(ShapeType type) {
    ShapeDef out;
    out.type = type;
    return out;
  }
  template <size_t place>
  ShapeDef shape(const ListedShapeDescription<place>& s, const std::string&) const {
    return s.def;
  }
  ShapeDef shape(const ConvexHullShapeDescription& s, const std::string&) const {
    ShapeDef out = of_type(ShapeType::convex_hull);
    if (s.mesh.empty()) {
      auto points = std::make_shared<TriangleMesh>();
      points->vertices = s.points;
      out.mesh = std::move(points);
    } else {
      out.mesh = meshes.find(s.mesh);
    }
    return out;
  }
  ShapeDef shape(const TriangleMeshShapeDescription& s, const std::string&) const {
    ShapeDef out = of_type(ShapeType::triangle_mesh);
    out.mesh = meshes.find(s.mesh);
    return out;
  }
  /// The mesh as drawn.
  ShapeDef shape(const MeshShapeDescription& s, const std::string& path) const {
    const auto mode = how(s).mode;
    ShapeDef out =
        of_type(mode == MeshMode::convex_hull ? ShapeType::convex_hull : ShapeType::triangle_mesh);
    out.mesh = meshes.wrapped(s.mesh, s.wrap, path, sink, warnings);
    return out;
  }
  /// The mode given by the shape, or else by its mesh.
  MeshModeDescription how(const MeshShapeDescription& s) const {
    const MeshDescription* m = scene.meshes.find(s.mesh);
    return s.how.mode || !m ? s.how : m->how;
  }

  BodyShapeDef body_shape(const ShapeDescription& s, const std::string& path,
                          const BodyDescription& body) const {
    BodyShapeDef out;
    out.shape = std::visit([&](const auto& kind) { return shape(kind, path); }, s.kind);
    out.pose = s.placement.pose();
    out.material = material(s.material ? s.material : body.material);
    if (body.density) out.material.density = *body.density;
    return out;
  }
  /// Adds a shape of a body, or for a mesh the shapes that approximate it. False after a fault.
  bool add_shapes(const ShapeDescription& s, const std::string& path, const BodyDescription& body,
                  BodyDef& out) const {
    const BodyShapeDef whole = body_shape(s, path, body);
    const auto* d = std::get_if<MeshShapeDescription>(&s.kind);
    if (!d) {
      const auto* hull = std::get_if<ConvexHullShapeDescription>(&s.kind);
      if (hull && !hull->mesh.empty() && whole.shape.mesh)
        if (const std::string note = hull_note(whole.shape.mesh);
            !note.empty() && meshes.says_first(*whole.shape.mesh, note))
          warnings.push_back(path + ": " + note);
      out.shapes.push_back(whole);
      return true;
    }
    const auto mesh = whole.shape.mesh;
    if (!mesh) return false;  // the fault was reported
    if (!d->how.mode && !d->wrap) {
      append_mesh_parts(out.shapes, whole, mesh, *meshes.parts(d->mesh));
      return true;
    }
    const auto parts = mesh_parts(mesh, representation_of(how(*d), bounds(*mesh)));
    if (!parts) {
      sink(path + ".mode", parts.error().text());
      return false;
    }
    if (!parts->note.empty() && meshes.says_first(*mesh, parts->note))
      warnings.push_back(path + ": " + parts->note);
    append_mesh_parts(out.shapes, whole, mesh, *parts);
    return true;
  }

  /// A constant number also becomes a course.
  static std::shared_ptr<const TimeCourse> course_of(const std::optional<Varying>& number,
                                                     double unit = 1) {
    if (!number) return nullptr;
    if (number->course) return tumble::course_of(*number, unit);
    return std::make_shared<const TimeCourse>(*TimeCourse::table({{0, unit * number->value}}));
  }

  DrawnShapeDef drawn_shape(const DrawnDescription& s, const std::string& path) const {
    DrawnShapeDef out;
    out.shape = std::visit([&](const auto& kind) { return shape(kind, path); }, s.kind);
    out.pose = s.placement.pose();
    if (s.colour) out.colour = s.colour->linear();
    return out;
  }

  /// Empty after a fault.
  std::optional<BodyDef> body(const BodyDescription& d) const {
    BodyDef out;
    out.type = d.type;
    out.velocity = d.velocity;
    out.angular_velocity = d.angular_velocity;
    if (d.angular_velocity_deg)
      for (int k = 0; k < 3; ++k)
        out.angular_velocity[k] = to_radians((*d.angular_velocity_deg)[k]);
    const std::string path = "bodies." + name;
    if (d.shape && !add_shapes(*d.shape, path + ".shape", d, out)) return std::nullopt;
    for (size_t i = 0; i < d.shapes.size(); ++i)
      if (!add_shapes(d.shapes[i], fmt::format("{}.shapes[{}]", path, i), d, out))
        return std::nullopt;
    if (d.course)
      out.course = std::make_shared<const BodyCourse>(
          BodyCourse{{course_of(d.course->x), course_of(d.course->y), course_of(d.course->z)},
                     d.course->axis,
                     course_of(d.course->angle_deg, to_radians(1))});
    for (size_t i = 0; i < d.drawn.size(); ++i)
      out.drawn.push_back(drawn_shape(d.drawn[i], fmt::format("{}.drawn[{}]", path, i)));
    out.mass = d.mass;
    out.inertia = d.inertia;
    out.products = d.products;
    out.centre = d.centre;
    out.group = uint32_t(d.group);
    out.gravity_scale = d.gravity_scale;
    out.fluid_friction = d.fluid_friction;
    out.can_sleep = d.can_sleep;
    out.precise = d.precise;
    out.starts_asleep = d.starts_asleep;
    out.hull_mass = d.hull_mass;
    if (d.colour) out.look.colour = d.colour->linear();
    out.look.roughness = float(d.look.roughness);
    out.look.metallic = float(d.look.metallic);
    out.look.pattern = float(d.look.pattern);
    out.look.opacity = float(d.look.opacity);
    out.look.visible = d.look.visible;
    return out;
  }

  void differ(BodyDef& out, const CopyDescription& d) const {
    if (d.type) out.type = *d.type;
    if (out.type != BodyType::kinematic) out.course = nullptr;
    if (d.position) out.pose.x = *d.position;
    if (d.euler_deg) out.pose.q = euler_deg_to_quat(*d.euler_deg);
    if (d.velocity) out.velocity = *d.velocity;
    if (d.angular_velocity) out.angular_velocity = *d.angular_velocity;
    for (BodyShapeDef& shape : out.shapes) {
      Material& m = shape.material;
      if (d.material) m = material(d.material);
      if (d.density) m.density = *d.density;
      if (d.material || d.density) m.density *= shape.filled;
    }
    if (d.density) {
      out.mass.reset();
    }
    if (d.mass) out.mass = d.mass;
    if (d.gravity_scale) out.gravity_scale = *d.gravity_scale;
    if (d.fluid_friction) out.fluid_friction = *d.fluid_friction;
    if (d.starts_asleep) out.starts_asleep = *d.starts_asleep;
    if (d.colour) out.look.colour = d.colour->linear();
  }
};

bool has_all_meshes(const BodyDef& def) {
  for (const BodyShapeDef& s : def.shapes)
    if (made_of_mesh(s.shape.type) && !s.shape.mesh) return false;
  for (const DrawnShapeDef& s : def.drawn)
    if (made_of_mesh(s.shape.type) && !s.shape.mesh) return false;
  return true;
}

}  // namespace

std::vector<BodyDef> body_defs(const SceneDescription& scene, const std::string& name,
                               const BodyDescription& body, const SceneMeshes& meshes,
                               const FaultSink& sink, std::vector<std::string>& warnings) {
  const Maker maker{scene, name, meshes, sink, warnings};
  const std::optional<BodyDef> common = maker.body(body);
  if (!common || !has_all_meshes(*common)) return {};  // the fault about the mesh was reported
  const auto poses = copy_poses(scene, name, body, warnings);
  if (!poses) {
    sink(poses.error().place, poses.error().message);
    return {};
  }
  std::map<std::string, const CopyDescription*, std::less<>> copies;
  for (const auto& copy : body.copies.items) copies.emplace(copy.name, &copy.value);
  std::vector<BodyDef> out;
  out.reserve(poses->size());
  for (size_t i = 0; i < poses->size(); ++i) {
    BodyDef def = *common;
    def.name = body.repeat.empty() ? name : fmt::format("{}[{}]", name, i);
    def.pose = (*poses)[i];
    if (!body.colours.empty()) def.look.colour = body.colours[i % body.colours.size()].linear();
    if (const auto copy = copies.find(std::to_string(i)); copy != copies.end()) {
      if (!copy->second->present) continue;
      maker.differ(def, *copy->second);
    }
    out.push_back(std::move(def));
  }
  return out;
}

}  // namespace tumble
