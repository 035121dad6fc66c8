#include "viewer/app/scenes/scene_look.hpp"

#include "engine/collision/shape.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/build.hpp"
#include "engine/world/world.hpp"
#include "viewer/render/scene_scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace tumble {

namespace {

/// Greatest size of surroundings, and greatest depth of fall, that are included in the view, over
/// the size of what moves [-].
constexpr double largest_surroundings = 8;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Height of the highest surface of scenery, or of the ground, directly below what moves; empty if
/// it is too far below, or there is none.
std::optional<double> landing_height(const Aabb& moving, const std::vector<Aabb>& scenery,
                                     std::optional<double> ground) {
  std::optional<double> height = ground;
  for (const Aabb& box : scenery) {
    const bool under = box.min.x() < moving.max.x() && box.max.x() > moving.min.x() &&
                       box.min.z() < moving.max.z() && box.max.z() > moving.min.z();
    if (under && box.max.y() <= moving.min.y())
      height = std::max(box.max.y(), height.value_or(box.max.y()));
  }
  const double deepest = moving.min.y() - largest_surroundings * moving.extent().norm();
  return height && *height >= deepest ? height : std::nullopt;
}

/// Removes boxes outside of `home`, unless all are.
void leave_out_what_has_left(const Aabb& home, std::vector<Aabb>& boxes) {
  const Aabb region = home.inflated(flown_away * 0.5 * home.extent().norm());
  const auto has_left = [&](const Aabb& box) { return !region.contains(box.centre()); };
  if (!std::all_of(boxes.begin(), boxes.end(), has_left)) std::erase_if(boxes, has_left);
}

}  // namespace

Aabb interesting_bounds(const Frame& frame, const std::optional<Aabb>& home) {
  std::vector<Aabb> moving_boxes, all, scenery;
  std::optional<double> ground;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null()) continue;
    frame.info(slot).for_seen([&](const BodyShape& part, const Vec3f&) {
      const Aabb box = part.shape->bounds(frame.body(slot).pose * part.pose);
      if (!box.min.allFinite() || !box.max.allFinite()) {
        // Only level ground has a bounded height.
        if (std::isfinite(box.max.y())) ground = std::max(box.max.y(), ground.value_or(-infinite));
        return;
      }
      all.push_back(box);
      if (frame.info(slot).type == BodyType::dynamic)
        moving_boxes.push_back(box);
      else
        scenery.push_back(box);
    });
  }
  for (const auto& system : frame.particles)
    for (const Vec3& x : system->x) moving_boxes.push_back({x, x});
  if (home) leave_out_what_has_left(*home, moving_boxes);
  const Aabb moving = bounds_of_most(moving_boxes);
  if (moving.empty())
    return all.empty() ? Aabb{Vec3(-1, 0, -1), Vec3(1, 2, 1)} : bounds_of_most(all);
  Aabb shown = moving;
  if (const auto height = landing_height(moving, scenery, ground))
    shown.include(Vec3(moving.centre().x(), *height, moving.centre().z()));
  const double limit = largest_surroundings * shown.extent().norm();
  for (const Aabb& box : scenery)
    if (box.extent().norm() <= limit) shown.include(box);
  return shown;
}

namespace {

/// The keys of a path at a moment between two frames, moved with the bodies that they follow.
std::vector<CameraKey> keys_at(const std::vector<CameraKey>& path, const Frame& from,
                               const Frame& to, double s) {
  return carried_along(path, [&](const std::string& name) -> std::optional<Vec3> {
    for (size_t slot = 0; slot < to.body_slots(); ++slot)
      if (!to.body(slot).id.is_null() && to.info(slot).name == name)
        return interpolated_pose(from, to, slot, s).x;
    return std::nullopt;
  });
}

}  // namespace

Camera ViewPoint::at(const Frame& from, const Frame& to, double s) const {
  const double time = from.time + s * (to.time - from.time);
  Camera moved = path.empty() ? camera : camera_at(keys_at(path, from, to, s), time);
  if (follow.is_null() || follow.index >= to.body_slots() || to.body(follow.index).id != follow)
    return moved;
  const Vec3 shift = interpolated_pose(from, to, follow.index, s).x - follow_x;
  moved.eye += shift;
  moved.target += shift;
  return moved;
}

Result<ViewPoint> find_view_point(const BuiltScene& scene, std::string_view name, double aspect) {
  const auto& cameras = scene.description->cameras;
  ViewPoint view;
  if (cameras.empty() && name.empty()) {
    view.name = "automatic";
    view.camera =
        frame_bounds(interesting_bounds(*scene.world->frame()), Vec3(0.6, 0.45, 1), 40, aspect);
    return view;
  }
  const auto found = name.empty() ? cameras.items.begin()
                                  : std::find_if(cameras.items.begin(), cameras.items.end(),
                                                 [&](const auto& c) { return c.name == name; });
  if (cameras.empty())
    return Error{ErrorCode::not_found,
                 "unknown camera '" + std::string(name) + "': the scene has no cameras",
                 {},
                 "leave --camera away for one that sees everything"};
  if (found == cameras.items.end())
    return Error{ErrorCode::not_found, unknown_name("camera", name, cameras.names()), {}, {}};
  const CameraDescription& d = found->value;
  view.name = found->name;
  view.camera.eye = d.position;
  view.camera.target = d.target;
  view.camera.fov_deg = d.fov_deg;
  for (const CameraKeyDescription& key : d.path) {
    CameraKey& k = view.path.emplace_back(CameraKey{key.time, view.camera});
    k.camera.eye = key.position;
    k.camera.target = key.target;
    k.camera.fov_deg = key.fov_deg.value_or(d.fov_deg);
  }
  if (!view.path.empty()) view.camera = camera_at(view.path, 0);
  if (const auto body = scene.bodies.find(d.follow); body != scene.bodies.end()) {
    view.follow = body->second;
    view.follow_x = scene.world->frame()->body(view.follow.index).pose.x;
  }
  return view;
}

std::vector<BodyNote> body_notes(const BuiltScene& scene) {
  std::vector<BodyNote> notes;
  for (const auto& [name, id] : scene.bodies) {
    const std::string_view own = std::string_view(name).substr(0, name.find('['));
    const auto& bodies = scene.description->bodies.items;
    const auto found =
        std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == own; });
    if (found == bodies.end()) continue;
    const LookDescription& look = found->value.look;
    if (look.label.empty() && !look.volumes) continue;
    notes.push_back({id, look.label, look.volumes.value_or(""), look.volumes_level});
  }
  return notes;
}

Overlays overlays_of(const SceneDescription& description) {
  std::string names;
  for (const std::string& name : description.look.overlays) names += name + ",";
  // The names were checked when the scene was read.
  const auto parsed = parse_overlays(names);
  return parsed ? *parsed : Overlays{};
}

void apply_look(const SceneDescription& description, RenderScene& out) {
  const SunDescription& sun = description.lights.sun;
  out.sun.to_sun = -sun.direction;
  out.sun.colour = sun.colour.linear();
  out.sun.intensity = float(sun.intensity);
  const ViewDescription& look = description.look;
  out.sky.zenith = look.sky.zenith.linear();
  out.sky.horizon = look.sky.horizon.linear();
  out.sky.below = look.sky.below.linear();
  out.sky.ambient = float(description.lights.ambient);
  out.ground.visible = look.ground.visible;
  out.ground.height = look.ground.height;
  out.ground.colour = look.ground.colour.linear();
  out.ground.grid_colour = look.ground.line_colour.linear();
  out.ground.grid = look.ground.grid > 0;
  if (out.ground.grid) out.ground.grid_spacing = look.ground.grid;
  // The default density of the description corresponds to the renderer's haze of 1.
  out.haze = float(look.fog.density / FogDescription{}.density);
  out.haze_colour.reset();
  if (look.fog.colour) out.haze_colour = look.fog.colour->linear();
  out.exposure = float(look.exposure);
}

}  // namespace tumble
