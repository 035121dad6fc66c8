#pragma once
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/dynamics/sph/tolerances.hpp"

#include <algorithm>
#include <array>

namespace tumble {

/// A smoothing kernel W(r) in space: its integral is one, and it is zero from its reach on.
/// In u = max(0, 1 - r/reach) and w = max(0, 1/2 - r/reach) it is
///   cubic spline (Monaghan 1992):  8 / (pi reach^3)  (2 u^3 - 8 w^3)
///   Wendland C2 (1995):            21 / (2 pi reach^3)  u^4 (5 - 4 u)
class SmoothingKernel {
 public:
  SmoothingKernel() = default;
  SmoothingKernel(FluidKernelKind kind, double reach);

  FluidKernelKind kind() const { return kind_; }
  double reach() const { return reach_; }  ///< [m]
  double scale() const { return scale_; }  ///< the factor above [1/m3]

  double value(double r) const;  ///< W [1/m3]
  double slope(double r) const;  ///< dW/dr [1/m4]
  /// No slope over the distance is steeper than this, which it is where they meet [1/m5].
  double sharpest() const;

  /// What a half-space holds of the kernel about a point at a signed distance [m] from it [-], and
  /// minus its derivative [1/m]: the integral of W over the plane at that distance.
  double half_space(double distance) const;
  double plane(double distance) const;

 private:
  FluidKernelKind kind_ = FluidKernelKind::cubic_spline;
  double reach_ = 1, scale_ = 1;
};

/// In a lattice of particles, the largest eigenvalue of what pressures do to densities, over the
/// diagonal [-]: of the waves along the lattice's diagonal, among which the stiffest one is within
/// a hundredth. It grows with the number of particles in reach.
double stiffest_wave(const SmoothingKernel& kernel, double spacing);

}  // namespace tumble
