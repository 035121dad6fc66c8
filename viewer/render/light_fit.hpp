#pragma once
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// The view and resolution of the shadow map.
struct LightFit {
  Mat4 shadow_from_world = Mat4::Identity();  ///< maps the volume to 0..1 in x, y and depth
  Frustum volume{};                           ///< contains everything that can cast into the map
  double texel = 0;   ///< size of a texel on a surface that faces the sun [m]
  bool empty = true;  ///< there are no casters
};

/// Fits an orthographic view along the sun to the casters that can affect the picture. Sizes change
/// in steps of a quarter octave, and the corner is snapped to whole texels, so that shadow edges do
/// not crawl while bodies or camera move.
LightFit fit_light(const Aabb& casters, const Vec3& to_sun, const Mat4& clip_from_world,
                   int resolution);

/// The part of the ground plane that receives contact shade: x0, z0, width, depth [m].
struct ContactFit {
  double x0 = 0, z0 = 0, side = 1;
};
ContactFit fit_contact(const Aabb& casters, const Vec3& target, double view_distance,
                       int resolution);

}  // namespace tumble
