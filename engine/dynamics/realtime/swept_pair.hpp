#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <limits>

namespace tumble {

/// Two shapes on bodies that move from time 0 on, each until it is stopped.
struct SweptPair {
  const Shape &a, &b;
  Pose offset_a, offset_b;            ///< poses of the shapes relative to the bodies' centres
  const Motion &motion_a, &motion_b;  ///< of the bodies
  double stop_a = 0, stop_b = 0;      ///< times at which the bodies stop [s]
  double lever_a = 0, lever_b = 0;    ///< bounding radii of the bodies [m]
  /// Upper bounds on the angular velocity of the shapes as sets of points [rad/s]: rotation of a
  /// body of revolution about its axis does not change the set.
  double swing_a = 0, swing_b = 0;
  /// Points of a body that are farther than this from where the two touch do not get there within
  /// the tick [m]. Where it is given, bounds on how fast an overlap grows come from the velocities
  /// near the contact, in place of those of the whole bodies.
  double reach = std::numeric_limits<double>::infinity();
  double allowed = 0;  ///< overlap up to which a contact on the path does not stop the pair [m]
  double growth = 0;   ///< amount by which the overlap at time 0 may grow, if that allows more [m]
  /// Whether touching shapes are tested too; otherwise they are left to the solver.
  bool watch_touching = true;
  /// Whether the next contact of shapes that already touch is computed too, so that until then only
  /// the approach along the normals counts; otherwise any motion counts. For thick surfaces of
  /// triangles that overlap this is expensive, and would find some triangle inside the overlap.
  bool time_touching = true;
  double tolerance = 0;  ///< precision of times of contact as a distance: see time_of_contact() [m]
  NarrowPhase narrow_phase;
  const TimeOfContactOptions& contact_time;
};

/// When a pair must be stopped, and where.
struct SweptStop {
  double time = std::numeric_limits<double>::infinity();  ///< infinite: never [s]
  /// The shapes touch already, and would overlap too deeply at the point below.
  bool deepens = false;
  Vec3 at = Vec3::Zero();       ///< in world coordinates [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
};

/// The time in [0, h] at which a pair must be stopped so that its overlap never exceeds
/// max(allowed, overlap at 0 + growth).
///
/// Shapes that are apart are advanced to their next contact, which stops them if the approach for
/// the rest of the tick would exceed `allowed`. Shapes that touch are tested by the narrow phase so
/// often that the overlap cannot grow by more than half of `allowed` in between. The bound for that
/// is the approach velocity along each contact's normal, rotation included, so that spin about the
/// normal costs nothing. After 64 tests a pair that still touches is stopped where it was last
/// tested, as if it overlapped too deeply, so that it can lose its approach and does not stay there
/// for ever.
SweptStop swept_stop(const SweptPair& pair, double h);

/// Removes the approach velocity of two bodies along unit `normal` (from A to B) at the point `at`
/// [m] by one impulse without rebound or friction; fixed, kinematic and sleeping bodies do not
/// move. A pair that is stopped because it would overlap deeper must lose that velocity, or it
/// would be stopped there in every tick: the contacts of the next tick are found where it is, not
/// where it would go.
void stop_approach(RigidBody& a, RigidBody& b, const Vec3& at, const Vec3& normal);

}  // namespace tumble
