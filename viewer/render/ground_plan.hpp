#pragma once
#include "viewer/render/frame_setup.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// The ground plane as triangles: first those that a body may shade, which sample the shadow and
/// contact maps, then all others, which skip the maps and cost half as much.
struct GroundPlan {
  std::vector<std::array<float, 2>> corners;  ///< x, z [m]
  std::vector<uint32_t> triangles;            ///< three corners each
  uint32_t shaded = 0;                        ///< number of `triangles` of the first kind
};

/// Makes a raster of squares under everything that shades the ground, and a rim around it that
/// reaches to where haze hides the ground. The lines of the raster are at multiples of a power of
/// two [m], so that they stay in place while bodies move. `plan` keeps its memory between frames.
void plan_ground(const RenderScene& scene, const FrameSetup& setup, GroundPlan& plan);

}  // namespace tumble
