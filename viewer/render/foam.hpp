#pragma once
#include "viewer/render/liquid_neighbours.hpp"

#include <span>
#include <vector>

namespace tumble {

/// How white the liquid is at each particle, 0..1: where it takes in air. That is where particles
/// near the surface rush towards each other (the potential of trapped air of M. Ihmsen, N. Akinci,
/// G. Akinci and M. Teschner, "Unified spray, foam and air bubbles for particle-based fluids",
/// 2012), and of drops that fly alone. `v` are velocities [m/s], `share` densities over that at
/// rest. Zero for all if a particle is nowhere, or has neither.
std::vector<float> foam_of(const LiquidNeighbours& neighbours, std::span<const Vec3f> v,
                           std::span<const float> share);

}  // namespace tumble
