#include "viewer/render/soft_plan.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/cell_raster.hpp"
#include "viewer/render/sphere_plan.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Smaller balls and puffs would be no more than a dot and are left out [px].
constexpr double least_ball = 0.2, least_puff = 0.5;

template <class Ball>
bool in_picture(const Ball& ball, const ViewSetup& view, const Frustum& frustum, double least) {
  const Vec3 x = ball.centre.template cast<double>();
  const auto r = double(ball.radius);
  return frustum.sees_sphere(x, r) &&
         r * view.pixels_per_radian > least * (x - view.eye).dot(view.forward);
}

/// Rounds a rectangle, given in pixels from the lower left corner of the picture, outwards to whole
/// pixels counted from the top, as scissors need.
ScissorRect scissor_of(float left, float right, float low, float high, int width, int height) {
  const auto pixel = [](float x, int most) { return int(std::clamp(x, 0.f, float(most))); };
  const int x0 = pixel(left - 1, width - 1), x1 = pixel(right + 2, width);
  const int y0 = pixel(low - 1, height - 1), y1 = pixel(high + 2, height);
  return {x0, height - y1, std::max(x1 - x0, 1), std::max(y1 - y0, 1)};
}

/// Widening by a texel of smoke (two pixels) and by filters [px].
constexpr double smoke_rim = 5;
/// The path of a puff's shade is covered by this many rectangles.
constexpr int shade_pieces = 6;

class SmokePartsFinder {
 public:
  explicit SmokePartsFinder(const ViewSetup& view)
      : view_(view), raster_(view.width, view.height) {}

  void add(const Vec3& centre, double radius) { add_between(centre, centre, radius); }
  /// Marks the path of the shade, away from the sun, down to the lowest height of the scene.
  void add_shade(const SmokePuff& puff, const SmokeShade& shade) {
    const Vec3 x = puff.centre.cast<double>();
    // The sun is below the horizon: the shade goes up without end.
    if (!(shade.to_sun.y() > 0)) return raster_.mark_all();
    const double radius = double(puff.radius) + shade.blur;
    const double way = std::max(x.y() - shade.lowest, 0.0) / shade.to_sun.y();
    for (int i = 0; i < shade_pieces; ++i)
      add_between(x - way * i / shade_pieces * shade.to_sun,
                  x - way * (i + 1) / shade_pieces * shade.to_sun, radius);
  }
  std::vector<ScissorRect> parts() const { return raster_.rectangles(); }

 private:
  /// Marks the balls with centres on a line segment.
  void add_between(const Vec3& a, const Vec3& b, double radius) {
    if ((a - view_.eye).dot(view_.forward) < -radius &&
        (b - view_.eye).dot(view_.forward) < -radius)
      return;  // behind the eye
    const ProjectedDisc p = disc_in_picture(view_, a, radius, true),
                        q = disc_in_picture(view_, b, radius, true);
    if (!(p.outline_radius > 0) || !(q.outline_radius > 0)) return raster_.mark_all();
    raster_.mark({double(std::min(p.x - p.outline_radius, q.x - q.outline_radius)) - smoke_rim,
                  double(std::min(p.y - p.outline_radius, q.y - q.outline_radius)) - smoke_rim},
                 {double(std::max(p.x + p.outline_radius, q.x + q.outline_radius)) + smoke_rim,
                  double(std::max(p.y + p.outline_radius, q.y + q.outline_radius)) + smoke_rim});
  }

  const ViewSetup& view_;
  CellRaster raster_;
};

/// Bounding rectangle of discs in a picture.
ScissorRect area_of(const std::vector<ProjectedDisc>& discs, int width, int height) {
  float left = float(width), right = 0, low = float(height), high = 0;
  for (const ProjectedDisc& d : discs) {
    if (!(d.outline_radius > 0)) return {0, 0, width, height};
    left = std::min(left, d.x - d.outline_radius);
    right = std::max(right, d.x + d.outline_radius);
    low = std::min(low, d.y - d.outline_radius);
    high = std::max(high, d.y + d.outline_radius);
  }
  return scissor_of(left, right, low, high, width, height);
}

}  // namespace

LiquidPlan plan_liquid(const FluidSurface& fluid, const ViewSetup& view,
                       std::vector<GpuFluidParticle>& vertices) {
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
    ProjectedDisc disc = disc_in_picture(view, x, r, false);
    disc.cover_radius = disc_in_picture(view, x, double(p.least_radius()), true).cover_radius;
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
      const GpuFluidParticle vertex{
          {p.centre.x(), p.centre.y(), p.centre.z()}, p.radius, p.to_ball, p.foam, 0};
      vertices.insert(vertices.end(), 3, vertex);
    }
    if (!behind) plan.front = uint32_t(vertices.size() / 3);
  }
  plan.all = uint32_t(vertices.size() / 3);
  return plan;
}

std::optional<ScissorRect> shaded_area(const SunVeil& veil, const Vec3& to_sun, double lowest,
                                       const ViewSetup& view) {
  const ScissorRect all{0, 0, view.width, view.height};
  if (!(to_sun.y() > 0)) return all;  // the sun is below the horizon: the shade goes up without end
  const Mat4 world_from_veil = veil.veil_from_world.inverse();
  const auto place = [&](double u, double v, double depth) {
    return (world_from_veil * Vec4(u, v, depth, 1)).head<3>();
  };
  double reach = 1;
  for (const double u : {0.0, 1.0})
    for (const double v : {0.0, 1.0})
      reach = std::max(reach, (place(u, v, 0).y() - lowest) / to_sun.y() / veil.depth);
  Aabb seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = place(corner & 1, corner >> 1 & 1, corner & 4 ? reach : 0);
    const Vec4 clip = view.clip_from_world * Vec4(x.x(), x.y(), x.z(), 1);
    if (!(clip.w() > 1e-6 * (x - view.eye).norm())) return all;  // beside or behind the eye
    seen.include(Vec3(clip.head<3>() / clip.w()));
  }
  if (seen.max.x() < -1 || seen.min.x() > 1 || seen.max.y() < -1 || seen.min.y() > 1) return {};
  const auto pixel = [](double x, int size) { return float(0.5 * (x + 1) * size); };
  return scissor_of(pixel(seen.min.x(), view.width), pixel(seen.max.x(), view.width),
                    pixel(seen.min.y(), view.height), pixel(seen.max.y(), view.height), view.width,
                    view.height);
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

std::vector<ScissorRect> smoke_parts(const RenderScene& scene, const std::vector<GpuPuff>& puffs,
                                     const SmokeShade& shade, const ViewSetup& view) {
  SmokePartsFinder finder(view);
  for (const GpuPuff& p : puffs)
    finder.add({double(p.place[0]), double(p.place[1]), double(p.place[2])}, double(p.place[3]));
  if (shade.falls)
    for (const SmokePuff& p : scene.smoke)
      if (drawable(p)) finder.add_shade(p, shade);
  return finder.parts();
}

}  // namespace tumble
