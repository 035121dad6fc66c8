#pragma once
#include "viewer/render/liquid_neighbours.hpp"

#include <vector>

namespace tumble {

/// The ellipsoid by which a particle contributes to the surface of a liquid.
struct LiquidShape {
  Vec3 centre = Vec3::Zero();  ///< [m]
  /// Maps the ellipsoid, relative to its centre, to a ball whose radius is its longest half axis:
  /// symmetric, no eigenvalue below 1 [-].
  Mat3 to_ball = Mat3::Identity();
};

/// The shapes of all particles. In the interior they are balls at the particles. Near the surface
/// and near walls they are flattened by the weighted covariance matrix of the neighbours, and
/// particles outside or inside of the surface are moved to where the mean of their neighbours
/// places it, so that a plane surface and a thin sheet are drawn as such (J. Yu and G. Turk,
/// "Reconstructing surfaces of particle-based fluids using anisotropic kernels", 2013, section 4;
/// their smoothing moves all particles inwards, this one keeps those of a plane surface in place).
/// `whole` is, for each particle, how far it belongs to the liquid, 0..1; an isolated drop, 0, is a
/// ball. All are balls if a position is not finite.
std::vector<LiquidShape> liquid_shapes(const LiquidNeighbours& neighbours,
                                       std::span<const double> whole);

}  // namespace tumble
