#pragma once
#include "viewer/render/render_scene.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Transmittance of liquids and smoke for sunlight, as a raster perpendicular to the sun: every
/// cell has the colour of the light that remains behind all of them, and the depth where the first
/// begins. Computed on the CPU, particle by particle; smoke in order from the sun, so that each
/// puff knows how much light reaches it.
struct SunVeil {
  /// Maps the veil to 0..1 in the raster and in depth from the sun.
  Mat4 veil_from_world = Mat4::Identity();
  double depth = 1;                ///< length that depth 0..1 stands for [m]
  int size = 0;                    ///< cells along each side; 0: there is no veil
  std::vector<uint32_t> cells;     ///< RGBA bytes: transmitted colour, depth of the first
  std::vector<float> smoke_light;  ///< by puff: share of the sunlight that reaches it, 0..1
};

/// Whatever is outside of `region` is left out. Reuses the memory of `veil`.
void make_sun_veil(const RenderScene& scene, const Vec3& to_sun, const Aabb& region, int size,
                   SunVeil& veil);

/// Absorption coefficient of a liquid by colour channel [1/m].
Vec3f absorption(const FluidSurface& fluid);

}  // namespace tumble
