#pragma once
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Where the shadow map looks, and how coarse it is.
struct LightFit {
  Mat4 shadow_from_world = Mat4::Identity();  ///< to 0..1 in x, y and depth
  Frustum volume{};                           ///< what may cast into it
  double texel = 0;                           ///< [m] on a surface that faces the sun
  bool empty = true;                          ///< nothing casts
};

/// Fits an orthographic view along the sun to what casts shadows and can matter to the picture.
/// Sizes come in steps of a quarter octave and the corner lies on whole texels, so that edges do
/// not crawl while bodies or camera move.
LightFit fit_light(const Aabb& casters, const Vec3& to_sun, const Mat4& clip_from_world,
                   int resolution);

/// The part of the ground plane that gets contact shade: x0, z0, width, depth [m].
struct ContactFit {
  double x0 = 0, z0 = 0, side = 1;
};
ContactFit fit_contact(const Aabb& casters, const Vec3& target, double view_distance,
                       int resolution);

}  // namespace tumble
