#pragma once
#include "engine/dynamics/sph/smoothing_kernel.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// Particles by place, as NeighbourLists has them; the last place, which fills lists, has no
/// volume. d is the way from the other particle to this one, V its volume, f the slope of the
/// kernel over the distance, so that f d is the gradient of W.
struct FluidPoints {
  const double* x;
  const double* y;
  const double* z;
};
struct Vectors {
  const double* x;
  const double* y;
  const double* z;
};

/// A list of neighbours, and V f d of each of them: eight x, eight y, eight z and again, in single
/// precision, which halves what the loops over pairs read. They are rounded to 6e-8, as those of
/// the other in the pair are where both have the same volume: then pairs keep the momentum exactly.
struct FluidList {
  size_t place = 0;
  std::span<const uint32_t> others;
  const float* gradients = nullptr;
};

struct DensitySum {
  double share;       ///< sum of V W over the others [-]
  double gx, gy, gz;  ///< sum of V f d [1/m]
  double squares;     ///< sum of V |f d|^2 [1/m5]
};

// Each of these is the same eight sums in a fixed order for every instruction set.

/// Writes V f d of each neighbour to `gradients`, which has room for three times the list.
DensitySum sum_densities(const SmoothingKernel& kernel, const FluidPoints& points,
                         const double* volume, const FluidList& list, float* gradients);
/// Sum of V f d (value + value of the other).
Vec3 sum_gradients(const double* value, const FluidList& list);
/// Sum of V f (u - u of the other) . d.
double sum_rates(const Vectors& u, const FluidList& list);
/// Sum of V f (u - u of the other), and sum of V f alone.
Vec3 sum_diffused(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                  const Vectors& u, const FluidList& list);
double sum_slopes(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                  const FluidList& list);
/// Sum of V W (u of the other - u).
Vec3 sum_differences(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                     const Vectors& u, const FluidList& list);

}  // namespace tumble
