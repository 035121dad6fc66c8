#include "engine/dynamics/rigid/slender.hpp"

#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

std::optional<SlenderInertia> slender_inertia(const Mat3& inertia) {
  constexpr double ratio = 20;
  const PrincipalAxes principal = principal_axes(inertia);
  if (!(ratio * principal.moments.x() < principal.moments.z())) return std::nullopt;
  return SlenderInertia{principal.moments, principal.rotation};
}

void rotate_slender(const SlenderInertia& inertia, Quat& q, const Vec3& L, double h, int most) {
  const Vec3& I = inertia.moments;
  const double along = 1 / I.x() - 1 / I.z();
  double across = 1 / I.y() - 1 / I.z();
  // How fast a flat needle swings about its length on either side of its greatest moment.
  const double steps = std::ceil(h * L.norm() * std::sqrt(along * std::max(across, 0.0)) / 0.1);
  if (!(steps <= most)) across = 0;
  const int n = across > 0 ? std::max(1, int(steps)) : 1;
  Quat p = q * inertia.axes;
  // Turns about one principal axis, at the rate of that part of the energy.
  const auto about = [&](const Vec3& axis, double inverse, double step) {
    const double momentum = L.dot(p._transformVector(axis));
    p = p * axis_angle(axis, inverse * momentum * step);
  };
  for (int i = 0; i < n; ++i) {
    about(Vec3::UnitX(), along, 0.5 * h / n);
    if (across > 0) about(Vec3::UnitY(), across, h / n);
    about(Vec3::UnitX(), along, 0.5 * h / n);
  }
  // About L it turns at one rate all the time, which commutes with the turns about its own axes.
  q = integrate_rotation(p * inertia.axes.conjugate(), L / I.z(), h);
}

}  // namespace tumble
