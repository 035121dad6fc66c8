#pragma once
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/math/types.hpp"

#include <optional>

namespace tumble {

/// Whether all axes are principal ones, as those of balls and cubes, to within rounding: the
/// angular velocity of such a body needs no torque to stay, and its inertia no turning.
inline bool isotropic_inertia(const Mat3& inertia) {
  const double first = inertia(0, 0);
  return (inertia - first * Mat3::Identity()).cwiseAbs().maxCoeff() <=
         tolerances::inertia_entries * first;
}

/// Inertia of a needle: one principal moment is below a twentieth of the greatest, so that the
/// other two differ by less than a twentieth (none exceeds the sum of the others).
struct SlenderInertia {
  Vec3 moments = Vec3::Ones();   ///< principal, ascending [kg m2]
  Quat axes = Quat::Identity();  ///< principal axes to body axes
};

/// The principal form of an inertia tensor (body axes, positive definite), if it is slender.
std::optional<SlenderInertia> slender_inertia(const Mat3& inertia);

/// Turns a torque-free slender body for `h` seconds; `q` is its orientation, `L` its angular
/// momentum [kg m2/s], world axes, which stays as it is.
///
/// Strang splitting of the kinetic energy into the symmetric top with moments (I1, I3, I3), which
/// turns about L and about its own axis at constant rates (Goldstein, "Classical Mechanics", §5.7),
/// and what the middle moment I2 adds, turns about its axis (Touma & Wisdom 1994, "Lie-Poisson
/// integrators for rigid body dynamics in the solar system"). Needles of round section take one
/// step, which is exact; others as many as it takes to resolve how they swing about their length,
/// or, where that needs more than `most`, the exact motion of the top alone: the energy then
/// stays within a twentieth. Rules that iterate on the velocity at the middle of the step would
/// need steps far below I1 / I3 of a radian: a small error of the axis changes the energy by I3 /
/// I1 times its square.
void rotate_slender(const SlenderInertia& inertia, Quat& q, const Vec3& L, double h, int most);

}  // namespace tumble
