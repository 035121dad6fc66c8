#pragma once
#include "viewer/render/liquid_neighbours.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Whiteness of a liquid at each particle, 0..1: where it entrains air. That is near the surface
/// where particles approach each other fast (the trapped-air potential of M. Ihmsen, N. Akinci, G.
/// Akinci and M. Teschner, "Unified spray, foam and air bubbles for particle-based fluids", 2012),
/// and for isolated drops. `v` are velocities [m/s], `share` densities over the rest density [-].
/// All zero if `v` or `share` does not have one value per particle, or a position is not finite.
std::vector<float> foam_of(const LiquidNeighbours& neighbours, std::span<const Vec3f> v,
                           std::span<const float> share);

}  // namespace tumble
