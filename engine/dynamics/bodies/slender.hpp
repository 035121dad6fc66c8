#pragma once
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/math/types.hpp"

#include <optional>

namespace tumble {

/// Whether all axes are principal axes, as for balls and cubes, to within rounding: the angular
/// velocity of such a body is constant without torque, and its inertia in world axes does not
/// depend on orientation.
inline bool isotropic_inertia(const Mat3& inertia) {
  const double first = inertia(0, 0);
  return (inertia - first * Mat3::Identity()).cwiseAbs().maxCoeff() <=
         tolerances::inertia_entries * first;
}

/// Inertia of a needle: the least principal moment is less than a twentieth of the greatest, so
/// that the other two differ by less than a twentieth (none exceeds the sum of the others).
struct SlenderInertia {
  Vec3 moments = Vec3::Ones();   ///< principal moments, ascending [kg m2]
  Quat axes = Quat::Identity();  ///< rotation from principal axes to body axes
};

/// The principal form of an inertia tensor (body axes, positive definite), if it is that of a
/// needle.
std::optional<SlenderInertia> slender_inertia(const Mat3& inertia);

/// Rotates a torque-free slender body for `h` seconds; `q` is its orientation, `L` its constant
/// angular momentum, world axes [kg m2/s].
///
/// Strang splitting of the kinetic energy into that of a symmetric top with moments (I1, I3, I3),
/// which rotates about L and about its own axis at constant rates (Goldstein, "Classical
/// Mechanics", §5.7), and the remainder by the middle moment I2, a rotation about its axis (Touma &
/// Wisdom 1994, "Lie-Poisson integrators for rigid body dynamics in the solar system"). Needles of
/// round section take one step, which is exact. Others take as many as resolve how they swing about
/// their length; if that needs more than `most`, the exact motion of the top alone is used, and the
/// energy stays within a twentieth. Implicit midpoint rules would need steps far below I1 / I3 of a
/// radian, since a small error of the axis changes the energy by I3 / I1 times its square.
void rotate_slender(const SlenderInertia& inertia, Quat& q, const Vec3& L, double h, int most);

}  // namespace tumble
