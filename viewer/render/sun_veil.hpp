#pragma once
#include "viewer/render/render_scene.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// What liquids and smoke leave of the light of the sun, as seen from it: a raster in which every
/// cell has the colour that is left behind all of them, and where the first of them begins.
/// Computed without a graphics device, particle by particle; smoke from the sun outwards, so that
/// each puff knows what the ones before it have left.
struct SunVeil {
  Mat4 veil_from_world = Mat4::Identity();  ///< to 0..1 in the raster and in depth from the sun
  double depth = 1;                         ///< from 0 to 1 [m]
  int size = 0;                             ///< cells each way; 0: there is no veil
  std::vector<uint32_t> cells;              ///< RGBA bytes: colour left, depth of the first
  std::vector<float> smoke_light;           ///< by puff: share of the sun that reaches it, 0..1
};

/// `region`: what is beyond it is left out. Keeps the memory of `veil`.
void make_sun_veil(const RenderScene& scene, const Vec3& to_sun, const Aabb& region, int size,
                   SunVeil& veil);

/// By how much light weakens on a metre of a liquid.
Vec3f absorption(const FluidSurface& fluid);

}  // namespace tumble
