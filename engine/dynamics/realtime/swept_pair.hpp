#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <limits>

namespace tumble {

/// Two shapes on bodies that move from 0 on, each until it is stopped.
struct SweptPair {
  const Shape &a, &b;
  Pose offset_a, offset_b;            ///< of the shapes relative to the bodies' centres
  const Motion &motion_a, &motion_b;  ///< of the bodies
  double stop_a = 0, stop_b = 0;      ///< [s]
  double lever_a = 0, lever_b = 0;    ///< bounding radii of the bodies [m]
  /// Bounds on how fast the shapes turn as sets [rad/s]: what spins about the axis that it is round
  /// about stays where it is.
  double swing_a = 0, swing_b = 0;
  double allowed = 0;  ///< overlap that a contact on the way may reach without being stopped [m]
  double growth = 0;   ///< by which the overlap at 0 may grow, if that is more [m]
  /// Whether what touches is watched too; else it is left to the solver.
  bool watch_touching = true;
  /// Whether the next contact of what touches is timed too, so that only the approach along the
  /// normals matters until then; else any motion counts. Of thick surfaces of triangles in each
  /// other it costs much and would be some triangle inside the overlap.
  bool time_touching = true;
  double tolerance = 0;  ///< as in time_of_contact() [m]
  NarrowPhase narrow_phase;
  const TimeOfContactOptions& contact_time;
};

/// When a pair must be stopped, and why.
struct SweptStop {
  double time = std::numeric_limits<double>::infinity();  ///< infinite for never [s]
  bool deepens = false;    ///< the two touch already, and would overlap too far at the point below
  Vec3 at = Vec3::Zero();  ///< world [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
};

/// When, within [0, h], a pair must be stopped, so that its overlap never exceeds
/// max(allowed, overlap at 0 + growth).
///
/// What is apart is advanced to its next contact, which stops it if it would close by more than
/// `allowed` in what is left of the tick. What touches, so that nothing can be timed, is looked at
/// so often that the overlap cannot deepen by more than half of `allowed` in between. The bound on
/// that is the approach along each contact's normal, rotation included: a body that spins about the
/// normal costs no more than one at rest. After 64 looks a pair that still touches is stopped where
/// it was seen last, as if it overlapped deeper, so that it can lose its approach and does not turn
/// there for ever.
SweptStop swept_stop(const SweptPair& pair, double h);

/// Takes the approach of two bodies along unit `normal` (from A to B) at the point `at` [m] away by
/// one impulse without rebound or friction; fixed, kinematic and sleeping bodies stand firm. What
/// is held back because it would cut deeper has to lose that speed, or it hangs there for ever: the
/// contacts of the next tick are those of where it is, not of where it would go.
void stop_approach(RigidBody& a, RigidBody& b, const Vec3& at, const Vec3& normal);

}  // namespace tumble
