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

/// A list of neighbours, and V f for each of them.
struct FluidList {
  size_t place = 0;
  std::span<const uint32_t> others;
  const double* slopes = nullptr;
};

struct DensitySum {
  double share;       ///< sum of V W over the others [-]
  double gx, gy, gz;  ///< sum of V f d [1/m]
  double squares;     ///< sum of V |f d|^2 [1/m5]
};

// Each of these is the same eight sums in a fixed order for every instruction set.

/// Writes V f of each neighbour to `slopes`, which has room for all of the list.
DensitySum sum_densities(const SmoothingKernel& kernel, const FluidPoints& points,
                         const double* volume, const FluidList& list, double* slopes);
/// Sum of V f d (value + value of the other).
Vec3 sum_gradients(const FluidPoints& points, const double* value, const FluidList& list);
/// Sum of V f (u - u of the other) . d.
double sum_rates(const FluidPoints& points, const Vectors& u, const FluidList& list);
/// Sum of V f (u - u of the other).
Vec3 sum_diffused(const FluidPoints& points, const Vectors& u, const FluidList& list);
/// Sum of V W (u of the other - u).
Vec3 sum_differences(const SmoothingKernel& kernel, const FluidPoints& points, const double* volume,
                     const Vectors& u, const FluidList& list);

}  // namespace tumble
