#include "engine/collision/shape.hpp"
#include "engine/math/rotation.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/extract.hpp"
#include "viewer/render/extract_vectors.hpp"
#include "viewer/render/overlay_colours.hpp"
#include "viewer/render/scene_draw.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

const Vec4f spring_colour(0.75f, 0.78f, 0.82f, 1);

void line(RenderScene& out, const Vec3& a, const Vec3& b, const Vec4f& colour, float width = 1.5f) {
  out.lines.push_back(
      {.a = a.cast<float>(), .b = b.cast<float>(), .colour = colour, .width = width});
}

void mark(RenderScene& out, const Vec3& x, const Vec4f& colour, float size) {
  out.points.push_back({.x = x.cast<float>(), .colour = colour, .size = size});
}

void add_particle_contacts(const Frame& frame, const Overlays& overlays, double size,
                           RenderScene& out) {
  for (const ParticleContactFrame& c : *frame.particle_contacts) {
    if (overlays.contacts)
      mark(out, c.x_world, c.gap < 0 ? overlay_colour::overlap : overlay_colour::contact, 5);
    if (overlays.normals)
      line(out, c.x_world, c.x_world + 0.25 * size * c.normal, overlay_colour::normal, 2);
  }
}

/// Scale of the arrows of contact forces.
struct ForceScale {
  double median = 0;  ///< median impulse of the contacts with pressure [N s]; 0: there are none
  /// Contact forces begin inside the pressed bodies. If there are few contacts they are drawn over
  /// everything; in a heap they would be too dense.
  Occlusion within = Occlusion::none;
};

ForceScale force_scale(const Frame& frame) {
  constexpr size_t few = 300;
  std::vector<double> sizes;
  frame.for_contacts([&sizes](const ContactFrame& c) {
    const double size = c.impulse.norm();
    if (size > 0 && std::isfinite(size)) sizes.push_back(size);
  });
  if (sizes.empty()) return {};
  const auto middle = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return {*middle, sizes.size() <= few ? Occlusion::none : Occlusion::faint};
}

void add_contacts(const Frame& frame, const Overlays& overlays, RenderScene& out) {
  if (!(overlays.contacts || overlays.normals || overlays.forces)) return;
  const double size = typical_size(frame);
  if (frame.particle_contacts) add_particle_contacts(frame, overlays, size, out);
  const ForceScale scale = overlays.forces ? force_scale(frame) : ForceScale{};
  frame.for_contacts([&](const ContactFrame& c) {
    if (overlays.contacts)
      mark(out, c.x_world, c.gap < 0 ? overlay_colour::overlap : overlay_colour::contact, 6);
    if (overlays.normals)
      line(out, c.x_world, c.x_world + 0.5 * size * c.normal, overlay_colour::normal, 2);
    if (!overlays.forces) return;
    // A force of median size is drawn shorter than a body, so that it does not hide the body.
    // Longer ones grow with the logarithm, so that an impact does not leave the picture.
    constexpr double typical_length = 0.8;  // of a typical body's radius
    const double ratio = c.impulse.norm() / scale.median;
    if (!(ratio > 0)) return;
    const double length = size * typical_length * (ratio < 1 ? ratio : 1 + std::log(ratio));
    add_thin_arrow(out, c.x_world, c.impulse.normalized() * length, size, overlay_colour::force,
                   scale.within);
  });
}

void add_body_overlays(const Frame& frame, const std::vector<Pose>& poses, const Overlays& overlays,
                       RenderScene& out) {
  SceneDraw draw(out);
  for (size_t slot = 0; slot < poses.size(); ++slot) {
    const BodyFrame& body = frame.body(slot);
    if (body.id.is_null()) continue;
    Aabb bounds;
    for (const BodyShape& part : frame.info(slot).shapes) {
      const Pose pose = poses[slot] * part.pose;
      if (overlays.aabbs) bounds.include(part.shape->bounds(pose));
      if (overlays.collision_shape) add_wires(*part.shape, pose, overlay_colour::wire, out);
    }
    if (overlays.aabbs && !bounds.empty() && bounds.min.allFinite() && bounds.max.allFinite())
      draw_box(draw, bounds.min, bounds.max, overlay_colour::bounds);
  }
}

constexpr int coil_turns = 8, lines_per_turn = 10, lines_of_coil = coil_turns * lines_per_turn + 2;
/// Greatest number of lines for all coils that a renderer draws fluently. A net with more springs
/// draws each as one line that surfaces hide.
constexpr size_t most_coil_lines = 20000;

/// A coil of eight turns with straight ends.
void add_coil(const Vec3& a, const Vec3& b, double radius, RenderScene& out) {
  const double length = (b - a).norm();
  if (!(length > 1e-9) || !std::isfinite(length)) return;
  const Vec3 along = (b - a) / length;
  Vec3 u, v;
  tangent_frame(along, u, v);
  constexpr int turns = coil_turns, per_turn = lines_per_turn;
  const double lead = 0.12 * length;
  Vec3 last = a + lead * along;
  line(out, a, last, spring_colour, 2.5f);
  for (int i = 1; i <= turns * per_turn; ++i) {
    const double angle = 2 * M_PI * i / per_turn;
    const double grow = std::min({1.0, i / 5.0, (turns * per_turn - i) / 5.0});
    const Vec3 next = a + (lead + (length - 2 * lead) * i / (turns * per_turn)) * along +
                      grow * radius * (std::sin(angle) * u + (1 - std::cos(angle)) * 0.5 * v);
    line(out, last, next, spring_colour, 2.5f);
    last = next;
  }
  line(out, last, b, spring_colour, 2.5f);
}

/// Draws stiff springs, which stand for ropes and rods, as solid bodies with shadows.
void add_cable(const Vec3& a, const Vec3& b, double radius, RenderScene& out) {
  const double length = (b - a).norm();
  if (!(length > 1e-9) || !std::isfinite(length)) return;
  Paint paint;
  paint.colour = Vec3f(0.07f, 0.075f, 0.08f);
  paint.roughness = 0.5f;
  const Pose pose{0.5 * (a + b), rotation_between(Vec3::UnitY(), (b - a).normalized())};
  out.instances.push_back(capsule_instance(pose, radius, 0.5 * length, paint));
}

void add_net_line(const Vec3& a, const Vec3& b, RenderScene& out) {
  line(out, a, b, spring_colour, 1.25f);
  out.lines.back().occlusion = Occlusion::hidden;
}

bool is_coil(const ForceFrame& force) {
  const auto* spring = std::get_if<SpringDef>(&force.def);
  return spring && force.points.size() >= 2 && !(spring->cable_radius > 0);
}

void add_forces(const Frame& frame, bool anchors, RenderScene& out) {
  const auto coils = size_t(std::count_if(frame.forces.begin(), frame.forces.end(), is_coil));
  const bool net = coils * lines_of_coil > most_coil_lines;
  for (const ForceFrame& force : frame.forces) {
    const auto* spring = std::get_if<SpringDef>(&force.def);
    if (spring && force.points.size() >= 2 && spring->cable_radius > 0)
      add_cable(force.points[0], force.points[1], spring->cable_radius, out);
    else if (is_coil(force) && net)
      add_net_line(force.points[0], force.points[1], out);
    else if (is_coil(force))
      add_coil(force.points[0], force.points[1], std::clamp(0.05 * spring->rest_length, 0.01, 0.1),
               out);
    if (const auto* mouse = std::get_if<MouseSpringDef>(&force.def);
        mouse && !force.points.empty()) {
      line(out, force.points[0], mouse->target, overlay_colour::anchor, 2.5f);
      mark(out, force.points[0], overlay_colour::anchor, 9);
      mark(out, mouse->target, overlay_colour::anchor, 7);
    }
    if (!anchors || std::holds_alternative<SpringMeshDef>(force.def)) continue;
    for (const Vec3& x : force.points) mark(out, x, overlay_colour::anchor, 8);
  }
}

/// The axes of a joint's frame on one body: red, green, blue.
void add_axes(const Pose& frame, double size, RenderScene& out) {
  for (int k = 0; k < 3; ++k)
    line(out, frame.x, frame.x + size * frame.direction(Vec3::Unit(k)), overlay_colour::axes[k],
         k == 2 ? 3.5f : 2);
}

/// Distance joints are drawn as rods, and those with slack as ropes, whether or not joints are
/// shown; the others show their frames. The line from anchor to anchor is the travel of a slider,
/// or else the position error of the joint.
void add_joints(const Frame& frame, bool shown, RenderScene& out) {
  if (!frame.joints || frame.joints->empty()) return;
  const double size = shown ? 0.4 * typical_size(frame) : 0;
  for (const JointFrame& j : *frame.joints) {
    if (j.kind == JointKind::free) add_cable(j.frame_a.x, j.frame_b.x, 0.01, out);
    if (j.kind == JointKind::distance) add_cable(j.frame_a.x, j.frame_b.x, 0.015, out);
    if (!shown) continue;
    if (entry_of(j.kind).uses_axes) add_axes(j.frame_a, size, out);
    if (entry_of(j.kind).uses_axes) add_axes(j.frame_b, 0.7 * size, out);
    line(out, j.frame_a.x, j.frame_b.x, overlay_colour::anchor, 2.5f);
    mark(out, j.frame_a.x, overlay_colour::anchor, 9);
    mark(out, j.frame_b.x, overlay_colour::contact, 6);
  }
}

}  // namespace

void add_overlays(const Frame& frame, const Frame* before, const std::vector<Pose>& poses,
                  const Overlays& overlays, RenderScene& out) {
  add_forces(frame, overlays.joints, out);
  add_joints(frame, overlays.joints, out);
  add_contacts(frame, overlays, out);
  if (overlays.aabbs || overlays.collision_shape) add_body_overlays(frame, poses, overlays, out);
  add_vectors(frame, before, poses, overlays, out);
  if (overlays.forces) add_fields(frame, poses, out);
  if (overlays.grid) add_grid(frame, poses, out);
  if (overlays.sensors) add_sensors(frame, poses, out);
}

}  // namespace tumble
