#include "viewer/render/frame_setup.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/marks.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

std::array<float, 16> floats(const Mat4& m) {
  std::array<float, 16> out;
  for (int i = 0; i < 16; ++i) out[size_t(i)] = float(m.data()[i]);
  return out;
}
std::array<float, 4> four(const Vec3& v, double w = 0) {
  return {float(v.x()), float(v.y()), float(v.z()), float(w)};
}
std::array<float, 4> four(const Vec3f& v) {
  return {v.x(), v.y(), v.z(), 0};
}

/// Distance from the camera to its target, bounded so that everything derived from it is finite in
/// single precision [m].
double viewing_distance(const Camera& c) {
  const double distance = (c.eye - c.target).norm();
  return distance > 0 ? std::clamp(distance, 1e-3, 1e5) : 1e-3;
}

/// Objects farther than this many viewing distances are ignored when the depth range and the shadow
/// map are chosen [-].
constexpr double near_reach = 1000;
Aabb near_region(const Camera& c) {
  const Vec3 half = Vec3::Constant(near_reach * viewing_distance(c));
  return {c.target - half, c.target + half};
}

/// Bounds of what may cast shadows.
Aabb caster_bounds(const RenderScene& scene, const Aabb& region) {
  Aabb box = bounds_of(scene.spheres, region);
  for (const MeshInstance& i : scene.instances)
    if (i.casts_shadow && i.paint.opacity >= 1) box.include(part_within(bounds_of(i), region));
  return box;
}

// With the default sun these two make a surface look as bright as it is painted.
constexpr float sky_strength = 1.3f, base_exposure = 0.37f;

Vec3f rgb_of(uint32_t rgba) {
  return Vec3f(float(rgba & 255), float(rgba >> 8 & 255), float(rgba >> 16 & 255)) / 255;
}

struct Distances {
  double near, far, haze, shadow;
};

/// Near, far and haze follow the scale of what is looked at, from millimetres to kilometres.
Distances distances_of(const RenderScene& scene, const Aabb& content) {
  const Camera& c = scene.camera;
  const double look = viewing_distance(c);
  const double half = content.empty() ? look : 0.5 * content.extent().norm();
  const double radius = std::clamp(half, 1e-3, 20 * look);
  double to_content = content.empty() ? look : (c.eye - content.centre()).norm() - radius;
  // If the contents are spread wider than that, some of them may be next to the eye.
  if (half > radius) to_content = std::min(to_content, 0.0);
  Distances d;
  d.haze = 14 * std::max(look, std::min(radius, 3 * look));
  double nearest = to_content;
  if (scene.ground.visible) nearest = std::min(nearest, c.eye.y() - scene.ground.height);
  d.near = c.near > 0 ? c.near : std::clamp(0.5 * nearest, 0.01 * look, 0.3 * look);
  d.far = c.far > d.near ? c.far : std::max(30 * d.haze, to_content + 2.2 * radius);
  d.shadow = std::min(d.far, 6 * look + 2 * std::min(radius, 3 * look));
  return d;
}

/// The ground grid for a viewing distance: the chosen spacing at 8 to 80 times the spacing,
/// otherwise a power of ten finer or coarser; fine lines fade before they are left out.
struct GridLevel {
  double spacing, fade;
};
GridLevel grid_level(double chosen, double look) {
  const double spacing = std::max(chosen, 1e-6);
  const double decades = det::log(look / (8 * spacing)) / det::log(10.0);
  const double whole = std::floor(decades);
  const double over = std::clamp((decades - whole - 0.6) / 0.4, 0.0, 1.0);
  return {spacing * det::pow(10.0, whole), 1 - over};
}

/// The colour half-way to its grey: skylight mixes with light reflected by the surroundings, and
/// shadows of a saturated blue would look painted.
Vec3f muted(const Vec3f& c) {
  const float grey = c.dot(Vec3f(0.2126f, 0.7152f, 0.0722f));
  return 0.5f * (c + Vec3f::Constant(grey));
}

void set_light(const RenderScene& scene, GpuFrame& u) {
  const Sky& sky = scene.sky;
  u.sun_colour = four(Vec3f(scene.sun.colour * scene.sun.intensity));
  const float light = sky_strength * sky.ambient;
  u.zenith = four(Vec3f(muted(sky.zenith) * light));
  u.horizon = four(Vec3f(muted(sky.horizon) * light));
  u.below = four(Vec3f(sky.below * (1.5f * light)));
  u.sky_zenith = four(sky.zenith);
  // The sky fades into the same haze as the ground, so that no line separates them.
  const Vec3f h = scene.haze_colour.value_or(sky.horizon);
  u.sky_horizon = four(h);
  u.haze = four(rgb_of(rgba_bytes(Vec4f(h.x(), h.y(), h.z(), 1))));
  u.ground_colour = four(scene.ground.colour);
  u.grid_colour = four(scene.ground.grid_colour);
}

}  // namespace

QualityValues values_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 512, 64};
    case Quality::standard:
      return {4, 1024, 128};
    case Quality::high:
      return {4, 2048, 256};
  }
  return {4, 1024, 128};
}

FrameSetup make_frame_setup(const RenderScene& scene, int width, int height) {
  FrameSetup s;
  const QualityValues quality = values_of(scene.quality);
  const Aabb region = near_region(scene.camera);
  s.region = region;
  const Aabb casters = caster_bounds(scene, region);
  const Aabb content = content_bounds(scene, region);
  s.lowest = content.empty() ? region.min.y() : content.min.y();
  if (scene.ground.visible) s.lowest = std::min(s.lowest, double(scene.ground.height));
  const Distances d = distances_of(scene, content);
  const double aspect = double(width) / height;
  s.camera = scene.camera;
  s.camera.near = d.near;
  s.camera.far = d.far;
  const Mat4 view = view_matrix(s.camera);
  const double fov = s.camera.fov_deg;
  const double tangent = 1 / perspective_matrix(fov, 1, 1, 2)(1, 1);
  s.view.clip_from_world = perspective_matrix(fov, aspect, d.near, d.far) * view;
  s.view.eye = s.camera.eye;
  s.view.right = view.row(0).head<3>();
  s.view.up = view.row(1).head<3>();
  s.view.width = width;
  s.view.height = height;
  s.view.forward = -view.row(2).head<3>();
  s.view.pixels_per_radian = 0.5 * height / tangent;

  Vec3 to_sun = scene.sun.to_sun;
  if (!to_sun.allFinite() || to_sun.norm() < 1e-9) to_sun = Vec3::UnitY();
  to_sun.normalize();
  const Mat4 shadowed = perspective_matrix(fov, aspect, d.near, d.shadow) * view;
  const LightFit light = fit_light(casters, to_sun, shadowed, quality.shadow_size);
  s.shadows = scene.sun.shadows && !light.empty;
  s.view.shadows = !light.empty;
  s.view.shadow_volume = light.volume;
  s.view.shadow_from_world = light.shadow_from_world;
  s.view.shadow_size = quality.shadow_size;

  const double look = viewing_distance(s.camera);
  const ContactFit contact = fit_contact(casters, s.camera.target, look, quality.contact_size);
  const double contact_height = 10 * contact.side / quality.contact_size;

  s.view.contact_below = scene.ground.height + contact_height;
  s.shadow_texel = light.texel;
  s.contact_texel = contact.side / quality.contact_size;

  GpuFrame& u = s.uniforms;
  u.clip_from_world = floats(s.view.clip_from_world);
  u.shadow_from_world = floats(light.shadow_from_world);
  u.eye = four(s.camera.eye, d.far);
  u.view_right = four(Vec3(s.view.right * tangent * aspect));
  u.view_up = four(Vec3(s.view.up * tangent));
  u.view_forward = four(s.view.forward);
  u.to_sun = four(to_sun);
  set_light(scene, u);
  const Ground& g = scene.ground;
  const GridLevel grid = grid_level(g.grid_spacing, look);
  u.grid_colour[3] = float(grid.fade);
  u.ground = {float(g.height), float(grid.spacing), g.grid && g.grid_spacing > 0 ? 1.f : 0.f,
              float(scene.haze / d.haze)};
  u.contact = {float(contact.x0), float(contact.z0), float(1 / contact.side),
               float(1 / contact.side)};
  u.contact_look = {float(1 / contact_height), g.visible ? 0.8f : 0.f, 0, 0};
  u.shadow_look = {1.f / float(quality.shadow_size), float(1.2 * light.texel),
                   s.shadows ? 1.f : 0.f, 0};
  u.picture = {float(width), float(height), scene.ui_scale * scene.resolution,
               base_exposure * scene.exposure};
  return s;
}

}  // namespace tumble
