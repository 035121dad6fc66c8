#include "engine/dynamics/bodies/slender.hpp"

#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

/// Whether every principal moment is above `least`: all leading minors of I - least are positive.
bool all_above(const Mat3& I, double least) {
  const double a = I(0, 0) - least, b = I(1, 1) - least, c = I(2, 2) - least;
  const double d = I(1, 0), e = I(2, 0), f = I(2, 1);
  return a > 0 && a * b - d * d > 0 &&
         a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e) > 0;
}

}  // namespace

std::optional<SlenderInertia> slender_inertia(const Mat3& inertia) {
  constexpr double ratio = tolerances::needle_moment_ratio;
  // No moment exceeds the trace; this cheap test excludes most bodies.
  if (all_above(inertia, (1 + tolerances::principal_moments) / ratio * inertia.trace()))
    return std::nullopt;
  const PrincipalAxes principal = principal_axes(inertia);
  if (!(ratio * principal.moments.x() < principal.moments.z())) return std::nullopt;
  return SlenderInertia{principal.moments, principal.rotation};
}

void rotate_slender(const SlenderInertia& inertia, Quat& q, const Vec3& L, double h, int most) {
  const Vec3& I = inertia.moments;
  const double along = 1 / I.x() - 1 / I.z();
  double across = 1 / I.y() - 1 / I.z();
  // Rate at which a flat needle swings about its length.
  const double steps = std::ceil(h * L.norm() * std::sqrt(along * std::max(across, 0.0)) /
                                 tolerances::needle_swing_step);
  if (!(steps <= most)) across = 0;
  const int n = across > 0 ? std::max(1, int(steps)) : 1;
  Quat p = q * inertia.axes;
  // Rotates about one principal axis, at the rate of its part of the energy.
  const auto about = [&](const Vec3& axis, double inverse, double step) {
    const double momentum = L.dot(p * axis);
    p = p * axis_angle(axis, inverse * momentum * step);
  };
  for (int i = 0; i < n; ++i) {
    about(Vec3::UnitX(), along, 0.5 * h / n);
    if (across > 0) about(Vec3::UnitY(), across, h / n);
    about(Vec3::UnitX(), along, 0.5 * h / n);
  }
  // The rotation about L has one constant rate and commutes with those about the body's own axes.
  q = integrate_rotation(p * inertia.axes.conjugate(), L / I.z(), h);
}

}  // namespace tumble
