#include "viewer/render/soft_plan.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/sphere_plan.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Smaller ones are no more than a dot [px].
constexpr double least_ball = 0.2, least_puff = 0.5;

template <class Ball>
bool in_picture(const Ball& ball, const ViewSetup& view, const Frustum& frustum, double least) {
  const Vec3 x = ball.centre.template cast<double>();
  const auto r = double(ball.radius);
  return frustum.sees_sphere(x, r) &&
         r * view.pixels_per_radian > least * (x - view.eye).dot(view.forward);
}

/// What discs cover of a picture, whose rows are counted from the top.
ScissorRect area_of(const std::vector<ProjectedDisc>& discs, int width, int height) {
  float left = float(width), right = 0, low = float(height), high = 0;
  for (const ProjectedDisc& d : discs) {
    if (!(d.outline_radius > 0)) return {0, 0, width, height};
    left = std::min(left, d.x - d.outline_radius);
    right = std::max(right, d.x + d.outline_radius);
    low = std::min(low, d.y - d.outline_radius);
    high = std::max(high, d.y + d.outline_radius);
  }
  const auto pixel = [](float x, int most) { return int(std::clamp(x, 0.f, float(most))); };
  const int x0 = pixel(left - 1, width - 1), x1 = pixel(right + 2, width);
  const int y0 = pixel(low - 1, height - 1), y1 = pixel(high + 2, height);
  return {x0, height - y1, std::max(x1 - x0, 1), std::max(y1 - y0, 1)};
}

}  // namespace

LiquidPlan plan_liquid(const FluidSurface& fluid, const ViewSetup& view,
                       std::vector<GpuSphere>& vertices) {
  const Frustum frustum = frustum_of(view.clip_from_world);
  std::vector<const FluidParticle*> seen;
  std::vector<ProjectedDisc> discs;
  for (const FluidParticle& p : fluid.particles) {
    const Vec3 x = p.centre.cast<double>();
    const auto r = double(p.radius);
    // A ball around the eye has no outline.
    if (!drawable(p) || !in_picture(p, view, frustum, least_ball) ||
        !((x - view.eye).squaredNorm() > 1.05 * r * r))
      continue;
    const ProjectedDisc disc = disc_in_picture(view, x, r, true);
    seen.push_back(&p);
    discs.push_back(disc);
  }
  vertices.clear();
  if (seen.empty()) return {};
  LiquidPlan plan;
  plan.area = area_of(discs, view.width, view.height);
  DiscOcclusion occlusion;
  std::vector<uint8_t> hidden;
  std::vector<uint8_t> without_outline(discs.size());
  for (size_t i = 0; i < discs.size(); ++i) without_outline[i] = !(discs[i].outline_radius > 0);
  find_hidden(occlusion, discs, view.width, view.height, hidden);
  vertices.reserve(3 * seen.size());
  for (const bool behind : {false, true}) {
    for (size_t i = 0; i < seen.size(); ++i) {
      if ((hidden[i] && !without_outline[i]) != behind) continue;
      const FluidParticle& p = *seen[i];
      const GpuSphere ball{{p.centre.x(), p.centre.y(), p.centre.z()}, p.radius, {0, 0, 0, p.foam}};
      vertices.insert(vertices.end(), 3, ball);
    }
    if (!behind) plan.front = uint32_t(vertices.size() / 3);
  }
  plan.all = uint32_t(vertices.size() / 3);
  return plan;
}

std::vector<GpuPuff> plan_smoke(const RenderScene& scene, const ViewSetup& view,
                                const SunVeil& veil) {
  const Frustum frustum = frustum_of(view.clip_from_world);
  std::vector<std::pair<double, uint32_t>> order;  // by depth, the last first
  for (uint32_t i = 0; i < scene.smoke.size(); ++i)
    if (drawable(scene.smoke[i]) && in_picture(scene.smoke[i], view, frustum, least_puff))
      order.emplace_back(-(scene.smoke[i].centre.cast<double>() - view.eye).dot(view.forward), i);
  std::sort(order.begin(), order.end());
  std::vector<GpuPuff> out;
  out.reserve(order.size());
  for (const auto& [depth, i] : order) {
    const SmokePuff& p = scene.smoke[i];
    const float light = i < veil.smoke_light.size() ? veil.smoke_light[i] : 1;
    out.push_back(
        {{p.centre.x(), p.centre.y(), p.centre.z(), p.radius},
         {p.colour.x(), p.colour.y(), p.colour.z(), p.opacity},
         {light, p.glow, float(det::cos(double(p.turn))), float(det::sin(double(p.turn)))},
         {p.kind & 1 ? 0.5f : 0.f, p.kind & 2 ? 0.5f : 0.f}});
  }
  return out;
}

}  // namespace tumble
