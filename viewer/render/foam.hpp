#pragma once
#include "engine/math/types.hpp"

#include <span>
#include <vector>

namespace tumble {

/// A liquid's particles as its frame has them.
struct FoamInput {
  std::span<const Vec3> x;       ///< [m]
  std::span<const Vec3f> v;      ///< [m/s]
  std::span<const float> share;  ///< density over that at rest [-]
  double spacing = 0.1;          ///< of particles at rest [m]
};

/// How white the liquid is at each particle, 0..1: where it takes in air. That is where particles
/// near the surface rush towards each other (the potential of trapped air of M. Ihmsen, N. Akinci,
/// G. Akinci and M. Teschner, "Unified spray, foam and air bubbles for particle-based fluids",
/// 2012), and of drops that fly alone. Zero for all if a particle is nowhere.
std::vector<float> foam_of(const FoamInput& in);

}  // namespace tumble
