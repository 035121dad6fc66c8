#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Rolling and torsional friction of a contact: torques about axes in the tangent plane and about
/// the normal. Each is at most a lever arm times the normal force of all points of the contact
/// (Coulomb's law of rolling friction); a smaller torque suffices where it prevents relative
/// rotation. One such row serves all points, since a torque has no point of attack. Impulses are
/// those of one sub-step, on B, about the axes t1, t2 and normal of the contact.
struct TurningRow {
  double rolling = 0, torsional = 0;  ///< Contact::rolling_friction, torsional_friction [m]
  double m11 = 0, m12 = 0, m22 = 0;   ///< inverse of K = Ia^-1 + Ib^-1 in the tangent plane [kg m2]
  double rolling_mass = 0;            ///< 1 / its larger eigenvalue there [kg m2]
  double torsional_mass = 0;          ///< 1 / (n K n) [kg m2]
  /// Effect of rolling impulses on the rotation about n: t1 K n, t2 K n [1/(kg m2)]
  double k13 = 0, k23 = 0;
  Vec3 impulse = Vec3::Zero();  ///< about t1, t2, n [N m s]
  Vec3 sum = Vec3::Zero();      ///< likewise, sum over the tick

  /// `mobility` is K in the axes of the contact.
  void set_masses(const Mat3& mobility);
  /// Change of the impulse about t1, t2, n, given the bodies' relative angular velocity `turning`
  /// about these axes [rad/s] and the sum `pressure` of the normal impulses of the points [N s].
  Vec3 solve(const Vec3& turning, double pressure);
};

}  // namespace tumble
