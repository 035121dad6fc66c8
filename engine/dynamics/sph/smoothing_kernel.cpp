#include "engine/dynamics/sph/smoothing_kernel.hpp"

#include <cmath>
#include <numbers>

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

}  // namespace tumble
