#include "engine/dynamics/sph/smoothing_kernel.hpp"

#include <cmath>
#include <numbers>

namespace tumble {
namespace {

constexpr double pi = std::numbers::pi;

/// Integral of f over [a, b] by Simpson's rule.
template <class F>
double simpson(double a, double b, int intervals, const F& f) {
  const double h = (b - a) / intervals;
  double sum = f(a) + f(b);
  for (int k = 1; k < intervals; ++k) sum += (k % 2 == 1 ? 4 : 2) * f(a + k * h);
  return sum * h / 3;
}

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

double SmoothingKernel::interface_integral() const {
  return simpson(0, reach_, 2 * tolerances::kernel_table, [this](double d) {
    const double p = plane(d);
    return p * p;
  });
}

SmoothingKernel::WallShear SmoothingKernel::wall_shear(double distance) const {
  if (distance >= reach_) return {0, 0};
  const double d = std::max(distance, 0.0);
  const auto integral = [&](auto weight) {
    return simpson(d, reach_, 16, [&](double r) {
      return r > 0 ? -slope(r) * r * r * weight(d * d / (r * r)) : 0;
    });
  };
  return {pi / 4 * integral([](double c2) { return (1 - c2) * (1 - c2); }),
          pi / 2 * integral([](double c2) { return 1 - c2 * c2; })};
}

}  // namespace tumble
