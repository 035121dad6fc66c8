#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// A frictional collision at one point, in a frame whose first axis is the contact normal (from A
/// to B) and whose other two axes span the tangent plane.
struct PointImpact {
  /// Inverse of the effective mass: change of B's velocity relative to A's at the point, per
  /// impulse on B (and its opposite on A). Symmetric, positive semi-definite, first diagonal entry
  /// positive [1/kg].
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
  /// Work of the normal impulse until the greatest compression, <= 0 [J]
  double compression_work = 0;
  double friction_work = 0;  ///< work of the tangential impulse, <= 0 [J]
  bool stuck = false;        ///< slip ended and did not begin again
  bool reversed = false;     ///< slip ended and began again in another direction
  int steps = 0;             ///< pieces into which the process was divided
};

/// The collision by Routh's process with Stronge's energetic coefficient of restitution (Routh
/// 1905, art. 315; Stronge, "Rigid body collisions with friction", 1990; Coutinho 2013 §4.11.1).
///
/// The normal impulse grows from zero, and friction with it. While there is slip, friction opposes
/// it; its direction may change on the way (Keller 1986). Once slip is zero, friction holds it
/// there if that lies in the cone; otherwise slip grows along the one direction in which it stays
/// straight (Batlle 1996). Compression ends where the normal velocity is zero; the collision ends
/// when the normal impulse has returned the square of the restitution times the work of
/// compression. Energy never grows, for any mobility. Where the direction of slip changes, the
/// process is integrated to about 1e-12 of the velocity.
PointImpactResult energetic_impact(const PointImpact& impact);

}  // namespace tumble
