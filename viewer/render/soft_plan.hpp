#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/draw_plan.hpp"
#include "viewer/render/sun_veil.hpp"

namespace tumble {

/// The particles of a liquid that the camera sees, three equal vertices each: first those that no
/// other stands before, then the rest of those in the picture.
struct LiquidPlan {
  uint32_t front = 0, all = 0;  ///< numbers of particles
  ScissorRect area;             ///< of the picture, that they are within
};
LiquidPlan plan_liquid(const FluidSurface& fluid, const ViewSetup& view,
                       std::vector<GpuFluidParticle>& vertices);

/// The part of the picture in which the shade of a veil can fall, when nothing is below the height
/// `lowest`; none where that is out of sight.
std::optional<ScissorRect> shaded_area(const SunVeil& veil, const Vec3& to_sun, double lowest,
                                       const ViewSetup& view);

/// The puffs that the camera sees, far to near.
std::vector<GpuPuff> plan_smoke(const RenderScene& scene, const ViewSetup& view,
                                const SunVeil& veil);

/// The shade that smoke casts alone.
struct SmokeShade {
  bool falls = false;
  Vec3 to_sun = Vec3::UnitY();
  double lowest = 0;  ///< nothing is below this height [m]
  double blur = 0;    ///< what the raster of the veil adds to a puff's radius [m]
};
/// Parts of the picture that puffs and their shade are within, without overlap.
std::vector<ScissorRect> smoke_parts(const RenderScene& scene, const std::vector<GpuPuff>& puffs,
                                     const SmokeShade& shade, const ViewSetup& view);

}  // namespace tumble
