#pragma once
#include "viewer/render/frame_setup.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// The ground plane as triangles: first those that a body may shade, which look into the shadow and
/// contact maps, then all others, which need not and cost half as much.
struct GroundPlan {
  std::vector<std::array<float, 2>> corners;  ///< x, z [m]
  std::vector<uint32_t> triangles;            ///< three corners each
  uint32_t shaded = 0;                        ///< how many of `triangles` are of the first kind
};

/// A raster of squares under everything that shades the ground, and a rim around it out to where
/// haze has swallowed the ground. Its lines stand at whole multiples of a power of two, so that
/// they stay in place while bodies move. `plan` keeps its memory between frames.
void plan_ground(const RenderScene& scene, const FrameSetup& setup, GroundPlan& plan);

}  // namespace tumble
