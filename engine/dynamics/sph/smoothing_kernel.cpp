#include "engine/dynamics/sph/smoothing_kernel.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace tumble {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

SmoothingKernel::SmoothingKernel(FluidKernelKind kind, double reach)
    : kind_(kind),
      reach_(reach),
      scale_((kind == FluidKernelKind::cubic_spline ? 8 / pi : 21 / (2 * pi)) /
             (reach * reach * reach)) {}

double SmoothingKernel::value(double r) const {
  const double q = r / reach_, u = std::max(0.0, 1 - q);
  if (kind_ == FluidKernelKind::wendland) return scale_ * (u * u) * (u * u) * (5 - 4 * u);
  const double w = std::max(0.0, 0.5 - q);
  return scale_ * (2 * u * u * u - 8 * w * w * w);
}

double SmoothingKernel::slope(double r) const {
  const double q = r / reach_, u = std::max(0.0, 1 - q);
  if (kind_ == FluidKernelKind::wendland) return -20 * scale_ / reach_ * (1 - u) * u * u * u;
  const double w = std::max(0.0, 0.5 - q);
  return scale_ / reach_ * (24 * w * w - 6 * u * u);
}

double SmoothingKernel::sharpest() const {
  return (kind_ == FluidKernelKind::wendland ? 20 : 12) * scale_ / (reach_ * reach_);
}

double SmoothingKernel::half_space(double distance) const {
  if (distance < 0) return 1 - half_space(-distance);
  const double q = distance / reach_, u = std::max(0.0, 1 - q);
  const double u5 = u * u * u * u * u;
  if (kind_ == FluidKernelKind::wendland) return 21 * u5 * u * (1.0 / 6 - 1.5 / 7 * u + u * u / 14);
  const double w = std::max(0.0, 0.5 - q);
  // The two cubes, integrated one after the other over planes.
  return 16 * (u5 * (0.1 - u / 15) - 4 * w * w * w * w * w * (0.05 - w / 15));
}

double SmoothingKernel::plane(double distance) const {
  const double q = std::abs(distance) / reach_, u = std::max(0.0, 1 - q);
  const double u4 = u * u * u * u;
  if (kind_ == FluidKernelKind::wendland)
    return 21 / reach_ * u4 * u * (1 - 1.5 * u + 4.0 / 7 * u * u);
  const double w = std::max(0.0, 0.5 - q);
  return 16 / reach_ * (u4 * (0.5 - 0.4 * u) - 4 * w * w * w * w * (0.25 - 0.4 * w));
}

// A wave of pressures sin(k . x) pushes a particle by the sum of V f d sin(k . d) over the others,
// and that changes densities by the same sum once more. Along (1, 1, 1) d counts by the sum of its
// three indices.
double stiffest_wave(const SmoothingKernel& kernel, double spacing) {
  const int reach = int(kernel.reach() / spacing), furthest = 3 * reach;
  std::vector<double> pushes(size_t(furthest) + 1, 0.0);
  double diagonal = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const double r = std::sqrt(double(i * i + j * j + k * k));
        if (r == 0) continue;
        const double slope = kernel.slope(r * spacing);
        diagonal += slope * slope;
        pushes[size_t(std::abs(i + j + k))] += slope * std::abs(i + j + k) / r;
      }
  double stiffest = 0;
  for (int n = 1; n < tolerances::waves_of_lattice; ++n) {
    double push = 0;
    for (int m = 1; m <= furthest; ++m)
      push += pushes[size_t(m)] * det::sin(std::numbers::pi * n * m / tolerances::waves_of_lattice);
    stiffest = std::max(stiffest, push * push / 3);
  }
  return stiffest / diagonal;
}

}  // namespace tumble
