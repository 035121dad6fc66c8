#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/draw_plan.hpp"
#include "viewer/render/sun_veil.hpp"

namespace tumble {

/// The particles of a liquid that the camera sees, three equal vertices each: first those that no
/// other particle hides, then the others within the picture.
struct LiquidPlan {
  uint32_t front = 0, all = 0;  ///< number of particles in front, and of all
  ScissorRect area;             ///< part of the picture that contains them
};
LiquidPlan plan_liquid(const FluidSurface& fluid, const ViewSetup& view,
                       std::vector<GpuFluidParticle>& vertices);

/// The part of the picture where the shade of a veil can fall, given that nothing lies below the
/// height `lowest` [m]; empty if none of it is in view.
std::optional<ScissorRect> shaded_area(const SunVeil& veil, const Vec3& to_sun, double lowest,
                                       const ViewSetup& view);

/// The puffs that the camera sees, far to near.
std::vector<GpuPuff> plan_smoke(const RenderScene& scene, const ViewSetup& view,
                                const SunVeil& veil);

/// How far the shade of smoke reaches in a scene without liquids.
struct SmokeShade {
  bool falls = false;
  Vec3 to_sun = Vec3::UnitY();
  double lowest = 0;  ///< nothing is below this height [m]
  double blur = 0;    ///< widening of a puff's shade by the cells of the veil [m]
};
/// Disjoint parts of the picture that contain the puffs and their shade.
std::vector<ScissorRect> smoke_parts(const RenderScene& scene, const std::vector<GpuPuff>& puffs,
                                     const SmokeShade& shade, const ViewSetup& view);

}  // namespace tumble
