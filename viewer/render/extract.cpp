#include "viewer/render/extract.hpp"

#include "engine/collision/shape.hpp"
#include "engine/math/rotation.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/colour_map.hpp"
#include "viewer/render/extract_soft.hpp"
#include "viewer/render/extract_weaves.hpp"
#include "viewer/render/friction_cones.hpp"
#include "viewer/render/particle_colours.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

MeshRef mesh_of(const DrawnSurface& surface) {
  if (surface.indices.empty()) return nullptr;
  if (surface.normals.empty()) return make_mesh_from_triangles(surface.positions, surface.indices);
  std::vector<Vec3f> positions, normals;
  for (const Vec3& p : surface.positions) positions.push_back(p.cast<float>());
  for (const Vec3& n : surface.normals) normals.push_back(n.cast<float>());
  return make_mesh(std::move(positions), std::move(normals), surface.indices, false);
}

/// A distinct, pleasant colour for any number: the golden angle around the hue circle.
Vec3f island_colour(uint32_t island) {
  const double hue = std::fmod(double(island) * 0.61803398875, 1.0);
  const auto part = [hue](double shift) {
    const double h = std::fmod(hue + shift, 1.0);
    return float(0.2 + 0.6 * std::abs(2 * h - 1));
  };
  return {part(0), part(1.0 / 3), part(2.0 / 3)};
}

Vec3f state_colour(const BodyFrame& body, const BodyInfo& info) {
  if (info.type == BodyType::fixed) return {0.35f, 0.35f, 0.35f};
  if (info.type == BodyType::kinematic) return {0.75f, 0.75f, 0.75f};
  const Vec3f colour = island_colour(body.island);
  return body.asleep ? Vec3f(0.25f * colour) : colour;
}

/// Opacity of bodies that hide something under the microscope.
constexpr float seen_through = 0.3f;
constexpr double plane_reach = 200;  ///< half width of a tilted half-space as drawn [m]

/// Height of the ground that a shape represents (an upward half space); empty for all other shapes.
std::optional<double> ground_height(const Shape& shape, const Pose& pose) {
  const bool level = shape.is_half_space() && pose.direction(Vec3::UnitY()).y() > 1 - 1e-9;
  return level ? std::optional(pose.x.y()) : std::nullopt;
}

/// Places the label above the body, or at its centre if it is unbounded.
void add_body_label(const std::string& text, const Aabb& bounds, RenderScene& out) {
  if (bounds.empty() || !bounds.min.allFinite() || !bounds.max.allFinite()) return;
  TextLabel label;
  label.text = text;
  const Vec3 middle = bounds.centre();
  label.x =
      Vec3(middle.x(), bounds.max.y() + 0.06 * bounds.extent().norm(), middle.z()).cast<float>();
  label.size = 15;
  label.anchor = Vec3f(0.5f, 1, 0);
  out.texts.push_back(label);
}

void add_particle_legend(const ParticleFrame& p, const NiceScale& scale, RenderScene& out) {
  const QuantityName quantity = name_of(p.look.colour_by);
  std::string title(quantity.name);
  if (!p.name.empty()) title = p.name + ": " + title;
  out.legends.push_back({std::move(title), std::string(quantity.unit), scale.low, scale.high});
}

/// Where the particles of a system are a part `s` of the way from one frame to the next.
std::vector<Vec3> places_between(const ParticleFrame& from, const ParticleFrame& to, double s) {
  if (from.id != to.id) return to.x;
  std::vector<Vec3> places = to.x;
  size_t then = 0;  // index of the same particle in the frame before
  for (size_t i = 0; i < to.x.size(); ++i) {
    while (then < from.ids.size() && from.ids[then] < to.ids[i]) ++then;
    if (then == from.ids.size() || from.ids[then] != to.ids[i]) continue;
    const Vec3& x = from.x[then];
    places[i] = to.box.any() ? to.box.wrapped(x + s * to.box.shortest(to.x[i] - x))
                             : Vec3(x + s * (to.x[i] - x));
  }
  return places;
}

void add_spheres(const ParticleFrame& p, const std::vector<Vec3>& places,
                 const WovenParticles& woven, RenderScene& out) {
  const bool coloured = p.look.colour_by != ParticleQuantity::none &&
                        p.value.size() == p.x.size() && !p.range.empty();
  const NiceScale scale = coloured ? colour_scale(p) : NiceScale{};
  if (coloured) add_particle_legend(p, scale, out);
  for (size_t i = 0; i < places.size(); ++i) {
    if (woven.holds(p.id, p.ids[i])) continue;
    const Vec3f c =
        coloured ? viridis_linear(double(p.value[i]), scale.low, scale.high) : p.colour[i];
    out.spheres.push_back(
        {places[i].cast<float>(), float(p.radius[i]), Vec4f(c[0], c[1], c[2], 1 + float(p.glow))});
  }
}

void add_particles(const ParticleFrame& from, const ParticleFrame& to, double s,
                   const WovenParticles& woven, RenderScene& out) {
  const std::vector<Vec3> places = places_between(from, to, s);
  switch (to.look.style) {
    case ParticleStyle::spheres:
      return add_spheres(to, places, woven, out);
    case ParticleStyle::surface:
      return add_liquid(to, places, out);
    case ParticleStyle::smoke:
      return add_smoke(to, places, out);
  }
}

/// Adds particles with the colours that the microscope gives them.
void add_coloured(const ParticleFrame& p, const std::vector<Vec3>& places,
                  const ParticleColours& colours, RenderScene& out) {
  const std::string title = p.name.empty() ? colours.title : p.name + ": " + colours.title;
  out.legends.push_back({title, colours.unit, colours.low, colours.high});
  for (size_t i = 0; i < p.x.size(); ++i) {
    const Vec3f c = viridis_linear(double(colours.value[i]), colours.low, colours.high);
    out.spheres.push_back(
        {places[i].cast<float>(), float(p.radius[i]), Vec4f(c[0], c[1], c[2], 1)});
  }
}

/// By slot: whether the body is selected.
std::vector<bool> outlined_slots(const Frame& frame, const ExtractOptions& options) {
  std::vector<bool> out(frame.body_slots());
  const auto mark = [&](BodyId id) {
    if (!id.is_null() && id.index < out.size() && frame.body(id.index).id == id)
      out[id.index] = true;
  };
  mark(options.selected);
  for (const BodyId id : options.also_selected) mark(id);
  return out;
}

}  // namespace

NiceScale colour_scale(const ParticleFrame& p) {
  return nice_scale(p.range.low, p.range.high, p.look.finds_range());
}

MeshRef ShapeMeshes::find_or_make(const std::shared_ptr<const Shape>& shape) {
  const auto found = meshes_.find(shape.get());
  if (found != meshes_.end()) return found->second.mesh;
  if (shape->drawing().kind != ShapeDrawing::Kind::surface) return nullptr;
  return meshes_.emplace(shape.get(), Entry{shape, mesh_of(shape->drawn_surface())})
      .first->second.mesh;
}

void ShapeMeshes::prune() {
  std::erase_if(meshes_, [](const auto& e) { return e.second.shape.use_count() == 1; });
  hierarchies_.prune();
}

Paint paint_of(const Look& look, const Material& material, double time) {
  Paint paint;
  paint.colour = look.colour;
  paint.roughness = look.roughness;
  paint.metallic = look.metallic;
  paint.opacity = look.opacity;
  if (look.pattern > 0) {
    paint.pattern = Pattern::quarters;
    paint.pattern_strength = look.pattern;
  }
  const double belt = material.surface_velocity.x();
  if (belt != 0) {
    paint.pattern = Pattern::stripes;
    paint.pattern_strength = std::max(look.pattern, 0.25f);
    // The pattern repeats after two bands; the multiple of that would only cost precision.
    paint.pattern_shift = float(std::fmod(belt * time, 2.0 * double(paint.pattern_size)));
  }
  return paint;
}

void add_shape(const std::shared_ptr<const Shape>& shape, const Pose& pose, const Paint& paint,
               bool selected, ShapeMeshes& meshes, RenderScene& out) {
  using enum ShapeDrawing::Kind;
  const size_t before = out.instances.size();
  const ShapeDrawing drawing = shape->drawing();
  const Vec3& half = drawing.half;
  switch (drawing.kind) {
    case ball:
      out.instances.push_back(ellipsoid_instance(pose, half, paint));
      break;
    case capsule:
      out.instances.push_back(capsule_instance(pose, half.x(), half.y(), paint));
      break;
    case box:
      out.instances.push_back(box_instance(pose, half, paint));
      break;
    case cylinder:
      out.instances.push_back(cylinder_instance(pose, half.x(), half.y(), paint));
      break;
    case plane:
      if (!ground_height(*shape, pose))
        out.instances.push_back(
            mesh_instance(plane_mesh(), pose, Vec3(plane_reach, 1, plane_reach), paint));
      break;
    case surface:
      if (const MeshRef mesh = meshes.find_or_make(shape))
        out.instances.push_back(mesh_instance(mesh, pose, Vec3::Ones(), paint));
      break;
  }
  for (size_t i = before; i < out.instances.size(); ++i) out.instances[i].selected = selected;
}

void extract(const Frame& from, const Frame& to, double s, const ExtractOptions& options,
             ShapeMeshes& meshes, RenderScene& out) {
  out.clear_content();
  std::optional<double> ground;
  const double time = from.time + s * (to.time - from.time);
  std::vector<Pose> poses(to.body_slots());
  for (size_t slot = 0; slot < poses.size(); ++slot)
    if (!to.body(slot).id.is_null())
      poses[slot] = s >= 1 ? to.body(slot).pose : interpolated_pose(from, to, slot, s);
  const bool magnified =
      options.microscope &&
      meshes.microscope().look(to, poses, *options.microscope, options.microscope_said);
  const bool pair = magnified && find_microscope(options.microscope->algorithm)->of_pair();
  const int step =
      !magnified ? 0 : options.microscope_step.value_or(options.microscope->step_at(time));
  const auto is_specimen = [&](BodyId id) {
    return pair && (id == options.microscope->a || id == options.microscope->b);
  };
  const std::vector<bool> outlined = outlined_slots(to, options);
  for (size_t slot = 0; slot < poses.size(); ++slot) {
    const BodyFrame& body = to.body(slot);
    if (body.id.is_null()) continue;
    const BodyInfo& info = to.info(slot);
    if (!info.look.visible) continue;
    const bool selected = outlined[slot];
    const ShownHierarchy volumes = shown_hierarchy(to, slot, options);
    const BodyNote* note = options.find_note(body.id);
    Aabb bounds;
    info.for_seen([&](const BodyShape& part, const Vec3f& colour) {
      Paint paint = paint_of(info.look, part.material, time);
      paint.colour = colour;
      if (options.overlays.islands) paint.colour = state_colour(body, info);
      if (magnified && meshes.microscope().sees_through(body.id)) paint.opacity *= seen_through;
      const Pose pose = poses[slot] * part.pose;
      const bool drawn = is_specimen(body.id) && !part.shape->is_half_space();
      if (!drawn &&
          (!add_hierarchy(part.shape, pose, paint, volumes, meshes, out) || !volumes.tinted))
        add_shape(part.shape, pose, paint, selected, meshes, out);
      if (const auto height = ground_height(*part.shape, pose))
        ground = std::max(*height, ground.value_or(*height));
      if (note) bounds.include(part.shape->bounds(pose));
    });
    if (note && !note->label.empty()) add_body_label(note->label, bounds, out);
  }
  if (ground) out.ground.height = *ground;
  const WovenParticles woven(to);
  for (size_t i = 0; i < to.particles.size(); ++i) {
    const ParticleFrame& now = *to.particles[i];
    const ParticleFrame& then = i < from.particles.size() ? *from.particles[i] : now;
    const ParticleColours* colours =
        magnified ? meshes.microscope().colours(now.id, step) : nullptr;
    if (colours && colours->value.size() == now.x.size())
      add_coloured(now, places_between(then, now, s), *colours, out);
    else
      add_particles(then, now, s, woven, out);
  }
  add_weaves(from, to, s, out);
  const Frame* before = options.before ? options.before.get() : &from;
  add_overlays(to, before->tick + 1 == to.tick ? before : nullptr, poses, options.overlays, out);
  if (magnified) meshes.microscope().draw(step, options.microscope_plate, meshes, out);
  if (options.overlays.friction_cones) add_friction_cones(to, options.selected, out);
}

}  // namespace tumble
