#include "viewer/render/render_scene.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>
#include <limits>

namespace tumble {

Vec3f linear_from_srgb(uint32_t rgb) {
  Vec3f out;
  for (int i = 0; i < 3; ++i) {
    const double c = double((rgb >> (16 - 8 * i)) & 255u) / 255;
    out[i] = float(c <= 0.04045 ? c / 12.92 : det::pow((c + 0.055) / 1.055, 2.4));
  }
  return out;
}

std::span<const std::string_view> quality_names() {
  static constexpr std::string_view names[] = {"draft", "standard", "high"};
  return names;
}

Result<Quality> parse_quality(std::string_view name) {
  const auto names = quality_names();
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return Quality(i);
  return Error{ErrorCode::invalid_argument,
               "unknown quality '" + std::string(name) + "'",
               {},
               "draft, standard or high"};
}

Transform transform_of(const Pose& pose, const Vec3& scale) {
  const Mat3 m = pose.q.toRotationMatrix() * scale.asDiagonal();
  return {m.cast<float>(), pose.x.cast<float>()};
}

void RenderScene::clear_content() {
  instances.clear();
  spheres.clear();
  fluids.clear();
  smoke.clear();
  lines.clear();
  points.clear();
  texts.clear();
  legends.clear();
  plate.reset();
  ui.vertices.clear();
  ui.indices.clear();
  ui.draws.clear();
}

void RenderScene::look_like(const RenderScene& other) {
  camera = other.camera;
  sun = other.sun;
  sky = other.sky;
  ground = other.ground;
  exposure = other.exposure;
  haze_colour = other.haze_colour;
  haze = other.haze;
  quality = other.quality;
  selection_colour = other.selection_colour;
  resolution = other.resolution;
  ui_scale = other.ui_scale;
}

Aabb bounds_of(const MeshInstance& i) {
  Aabb box;
  if (!i.mesh || !i.transform.offset.allFinite() || !i.transform.linear.allFinite()) return box;
  const Mat3f& m = i.transform.linear;
  const Vec3f centre = m * (0.5f * (i.mesh->min + i.mesh->max)) + i.transform.offset;
  const Vec3f half =
      m.cwiseAbs() * (0.5f * (i.mesh->max - i.mesh->min)) + Vec3f::Constant(i.inflate);
  box.include(Vec3((centre - half).cast<double>()));
  box.include(Vec3((centre + half).cast<double>()));
  return box;
}

bool drawable(const SphereInstance& s) {
  return s.centre.allFinite() && s.radius > 0 && std::isfinite(s.radius);
}
bool drawable(const FluidParticle& p) {
  return p.centre.allFinite() && p.radius > 0 && std::isfinite(p.radius);
}
bool drawable(const SmokePuff& p) {
  return p.centre.allFinite() && p.radius > 0 && std::isfinite(p.radius) && p.opacity > 0;
}

Aabb everywhere() {
  const Vec3 far = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {-far, far};
}

Aabb part_within(const Aabb& box, const Aabb& region) {
  const Aabb part{box.min.cwiseMax(region.min), box.max.cwiseMin(region.max)};
  return part.empty() ? Aabb{} : part;
}

namespace {

/// Of things with a centre and a radius.
template <class Ball>
Aabb bounds_of_balls(const std::vector<Ball>& balls, const Aabb& within) {
  const Array3<float> first = within.min.cast<float>(), last = within.max.cast<float>();
  Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  for (const Ball& s : balls) {
    if (!drawable(s) || (s.centre.array() < first).any() || (s.centre.array() > last).any())
      continue;
    low = low.cwiseMin(s.centre - Vec3f::Constant(s.radius));
    high = high.cwiseMax(s.centre + Vec3f::Constant(s.radius));
  }
  return {low.cast<double>(), high.cast<double>()};
}

}  // namespace

Aabb bounds_of(const std::vector<SphereInstance>& spheres, const Aabb& within) {
  return bounds_of_balls(spheres, within);
}
Aabb soft_bounds(const RenderScene& scene, const Aabb& within) {
  Aabb box = bounds_of_balls(scene.smoke, within);
  for (const FluidSurface& fluid : scene.fluids)
    box.include(bounds_of_balls(fluid.particles, within));
  return box;
}

Aabb content_bounds(const RenderScene& scene, const Aabb& within) {
  Aabb box = bounds_of(scene.spheres, within);
  if (scene.has_soft_matter()) box.include(soft_bounds(scene, within));
  for (const MeshInstance& i : scene.instances) box.include(part_within(bounds_of(i), within));
  return box;
}

}  // namespace tumble
