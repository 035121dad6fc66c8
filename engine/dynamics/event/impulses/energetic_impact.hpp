#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// One frictional collision in one point, in a frame whose first axis is the contact normal (from A
/// to B) and whose other two span the tangent plane.
struct PointImpact {
  /// Change of B's velocity relative to A's, at the point, by a unit impulse on B (and its opposite
  /// on A): symmetric, positive semi-definite, its first diagonal entry positive [1/kg].
  Mat3 mobility = Mat3::Identity();
  Vec3 velocity = Vec3::Zero();  ///< of B relative to A at the point, before [m/s]
  double friction = 0;           ///< Coulomb coefficient, >= 0 [-]
  double restitution = 0;        ///< energetic coefficient, 0..1 [-]
};

enum class PointImpactStatus {
  solved,
  separating,  ///< the points do not approach: no impulse
  invalid,     ///< a value is not finite or out of range, or the mobility not positive definite
};

struct PointImpactResult {
  PointImpactStatus status = PointImpactStatus::solved;
  Vec3 impulse = Vec3::Zero();   ///< on B [N s]
  Vec3 velocity = Vec3::Zero();  ///< relative, after [m/s]
  double compression_work = 0;   ///< of the normal impulse until the greatest compression, <= 0 [J]
  double friction_work = 0;      ///< of the tangential impulse, <= 0 [J]
  bool stuck = false;            ///< slip came to rest and stayed so
  bool reversed = false;         ///< slip came to rest and began anew in another direction
  int steps = 0;                 ///< pieces of the way through the impulse
};

/// The collision by Routh's process with Stronge's energetic coefficient of restitution (Routh
/// 1905, art. 315; Stronge, "Rigid body collisions with friction", 1990; Coutinho 2013 §4.11.1).
///
/// The normal impulse grows from zero, and friction with it: against the slip while there is slip,
/// which may turn on its way (Keller 1986); what keeps it at zero once it got there, if the cone
/// holds that, else along the one direction in which slip grows straight (Batlle 1996). Compression
/// ends where the normal velocity is zero; the collision ends when the normal impulse has given
/// back the square of the restitution of the work that compression took. Energy never grows, for
/// any mobility. Where slip turns, the way is integrated to about 1e-12 of the velocity.
PointImpactResult energetic_impact(const PointImpact& impact);

}  // namespace tumble
