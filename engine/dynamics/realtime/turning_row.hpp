#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// How a contact resists turning: rolling friction about axes in its tangent plane, torsional
/// friction about its normal. Both are torques no greater than a lever arm times the normal force
/// of all points of the contact (Coulomb's law of rolling friction), and as great as it takes to
/// keep the bodies from turning against each other where less is enough. One such row stands for
/// all points: a torque has no place. Impulses are those of one sub-step, on B; axes are t1, t2 and
/// the normal of the contact.
struct TurningRow {
  double rolling = 0, torsional = 0;  ///< Contact::rolling_friction, torsional_friction [m]
  double m11 = 0, m12 = 0, m22 = 0;   ///< inverse of K = Ia^-1 + Ib^-1 in the tangent plane [kg m2]
  double rolling_mass = 0;            ///< 1 / its larger eigenvalue there [kg m2]
  double torsional_mass = 0;          ///< 1 / (n K n) [kg m2]
  double k13 = 0, k23 = 0;      ///< what rolling impulses do about n: t1 K n, t2 K n [1/(kg m2)]
  Vec3 impulse = Vec3::Zero();  ///< about t1, t2, n [N m s]
  Vec3 sum = Vec3::Zero();      ///< likewise, over the tick

  /// `mobility` is K in the axes of the contact.
  void set_masses(const Mat3& mobility);
  /// Change of the impulse about t1, t2, n for the bodies' relative angular velocity `turning`
  /// there [rad/s], where the points of the contact press with the impulse `pressure` in all [N s].
  Vec3 solve(const Vec3& turning, double pressure);
};

}  // namespace tumble
