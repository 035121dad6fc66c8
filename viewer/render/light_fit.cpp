#include "viewer/render/light_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The least of 1, 1.25, 1.5, 1.75 times a power of two that is not below x.
double step_up(double x) {
  int exponent = 0;
  const double fraction = std::frexp(std::max(x, 1e-6), &exponent);  // 0.5 .. 1
  const double steps = std::ceil(fraction * 8) / 8;
  return std::ldexp(steps, exponent);
}

Aabb in_frame(const Mat3& rows, const Aabb& box) {
  Aabb out;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p(i & 1 ? box.max.x() : box.min.x(), i & 2 ? box.max.y() : box.min.y(),
                 i & 4 ? box.max.z() : box.min.z());
    out.include(rows * p);
  }
  return out;
}

/// Bounds, in light axes, of what the camera sees.
Aabb view_in_frame(const Mat3& rows, const Mat4& clip_from_world) {
  const Mat4 world_from_clip = clip_from_world.inverse();
  Aabb out;
  for (int i = 0; i < 8; ++i) {
    const Vec4 c(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, 1);
    const Vec4 w = world_from_clip * c;
    out.include(rows * (w.head<3>() / w.w()));
  }
  return out;
}

}  // namespace

LightFit fit_light(const Aabb& casters, const Vec3& to_sun, const Mat4& clip_from_world,
                   int resolution) {
  LightFit fit;
  if (casters.empty()) return fit;
  const Vec3 z = to_sun.normalized();
  const Vec3 helper = std::fabs(z.y()) < 0.99 ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 x = helper.cross(z).normalized();
  const Mat3 rows = Mat3::from_rows(x, z.cross(x), z);

  Aabb box = in_frame(rows, casters);
  const Aabb seen = view_in_frame(rows, clip_from_world);
  for (int k = 0; k < 2; ++k) {
    box.min[k] = std::max(box.min[k], seen.min[k]);
    box.max[k] = std::min(box.max[k], seen.max[k]);
  }
  if (box.empty()) return fit;

  const double size = step_up(1.01 * std::max(box.extent().x(), box.extent().y()));
  fit.texel = size / (resolution - 8);
  const double side = fit.texel * resolution;
  double low[2];
  for (int k = 0; k < 2; ++k)
    low[k] = std::floor((box.centre()[k] - 0.5 * side) / fit.texel) * fit.texel;
  const double margin = 0.02 * box.extent().z() + 4 * fit.texel;
  const double near = -(box.max.z() + margin), far = -(box.min.z() - margin);
  const Mat4 light_from_world = Mat4::affine(rows, Vec3::Zero());
  const Mat4 clip = orthographic_matrix(low[0], low[0] + side, low[1], low[1] + side, near, far) *
                    light_from_world;
  fit.shadow_from_world = Mat4::affine(0.5 * Mat3::Identity(), Vec3::Constant(0.5)) * clip;
  fit.volume = frustum_of(clip);
  fit.empty = false;
  return fit;
}

ContactFit fit_contact(const Aabb& casters, const Vec3& target, double view_distance,
                       int resolution) {
  ContactFit fit;
  if (casters.empty()) return fit;
  const double reach = 1.5 * view_distance;
  double x0 = std::max(casters.min.x(), target.x() - reach);
  double x1 = std::min(casters.max.x(), target.x() + reach);
  double z0 = std::max(casters.min.z(), target.z() - reach);
  double z1 = std::min(casters.max.z(), target.z() + reach);
  if (x1 < x0) x0 = x1 = target.x();
  if (z1 < z0) z0 = z1 = target.z();
  fit.side = step_up(1.25 * std::max({x1 - x0, z1 - z0, 1e-3}));
  const double texel = fit.side / resolution;
  fit.x0 = std::floor((0.5 * (x0 + x1 - fit.side)) / texel) * texel;
  fit.z0 = std::floor((0.5 * (z0 + z1 - fit.side)) / texel) * texel;
  return fit;
}

}  // namespace tumble
