#pragma once
#include "viewer/render/liquid_neighbours.hpp"

#include <vector>

namespace tumble {

/// What a particle of a liquid is for the surface: an ellipsoid.
struct LiquidShape {
  Vec3 centre = Vec3::Zero();  ///< [m]
  /// Maps its points, as seen from the centre, to those of a ball as large as its longest half
  /// axis: symmetric, no eigenvalue below 1 [-].
  Mat3 to_ball = Mat3::Identity();
};

/// The shapes of all particles. Inside they are balls where the particles are. Near the surface and
/// near walls they are flattened across it, as the neighbours are spread (their weighted covariance
/// matrix), and what stands out of the surface or back from it is moved to where the mean of its
/// neighbours says that the surface is, so that a plane surface is one in the picture too, and a
/// thin sheet a sheet (J. Yu and G. Turk, "Reconstructing surfaces of particle-based fluids using
/// anisotropic kernels", 2013, section 4; their smoothing moves all particles inwards, this one
/// leaves those of a plane where they are). `whole` says of each how much it is part of the liquid,
/// 0..1; a drop that flies alone, 0, is a ball. Balls for all if a particle is nowhere.
std::vector<LiquidShape> liquid_shapes(const LiquidNeighbours& neighbours,
                                       std::span<const double> whole);

}  // namespace tumble
