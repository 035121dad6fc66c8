#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/pair_side.hpp"

#include <limits>

namespace tumble {

/// Contacts of two bodies may be carried along while these hardly move against each other if
/// both surfaces are made of planes. Round ones roll: only that they are apart is known for longer.
///
/// How far the points of a pair may move against each other before the narrow phase looks again,
/// where contacts are foreseen at `margin` [m].
double seen_tolerance(double margin);

/// A look at two bodies as they are, with all gaps up to `margin` found.
CachedPair look_at(const ContactKey& pair, const PairSide& a, const PairSide& b, double margin);

/// An upper bound on how far any point of the smaller side has moved against the larger one since
/// the look; infinite, which is found sooner, where that is more than `enough` [m].
double moved_since(const CachedPair& seen, const PairSide& a, const PairSide& b,
                   double enough = std::numeric_limits<double>::infinity());

/// How the smaller side of a pair moved since a look, in the frame of the larger one.
class MotionSince {
 public:
  /// From one relative_pose of the sides to another.
  MotionSince(const Pose& then, const Pose& now)
      : back_(then * now.inverse()), turn_(2 * back_.q.vec().norm()) {}

  /// How far what is at x now moved, whichever side it belongs to [m].
  double shift(const Vec3& x) const { return (x - back_.point(x)).norm(); }
  /// Bound on the same of all that is within `radius` of x [m].
  double shift(const Vec3& x, double radius) const { return shift(x) + turn_ * radius; }

 private:
  Pose back_;    ///< from where things are to where they were
  double turn_;  ///< no point moves farther by it than this times its distance from the axis
};

/// The frame of the smaller side in that of the larger one, of equal ones that of B in that of A.
Pose relative_pose(const PairSide& a, const PairSide& b);
/// Whether A is the smaller side.
inline bool smaller_first(const PairSide& a, const PairSide& b) {
  return a.shape_radius < b.shape_radius;
}

/// What a contact has from the materials of its two shapes, where the forces that its points
/// remember are known. Rolling and torsional friction stand for the width of the patch that a point
/// or a line leaves out; three points that press span theirs, and resist turning by where they
/// press and by their friction.
inline void take_surfaces(Contact& contact, const SideSurface& a, const SideSurface& b) {
  const CombinedMaterial combined = combine(a, b);
  const bool narrow = contact.pressing() < 3;
  contact.friction = combined.friction;
  contact.restitution = combined.restitution;
  const auto arm = [narrow](double of_a, double of_b) {
    return narrow ? std::sqrt(of_a * of_b) : 0;
  };
  contact.rolling_friction = arm(a.rolling_friction, b.rolling_friction);
  contact.torsional_friction = arm(a.torsional_friction, b.torsional_friction);
  if (!contact.resists_turning()) contact.turning_torque.setZero();
  contact.surface_velocity = a.belt - b.belt;
}
inline void take_materials(Contact& contact, const PairSide& a, const PairSide& b) {
  if (!in_pieces(a, b)) return take_surfaces(contact, a, b);
  take_surfaces(contact, a.surface_of(contact.shapes.a), b.surface_of(contact.shapes.b));
}

/// A contact of the look, at the bodies' present poses: its points stay where they are on the two
/// bodies, its normal turns with A, and it has not pressed yet. The gaps are exact where planes of
/// A meet corners of B; in general their error is of second order in what the bodies moved.
void carry_along(Contact& contact, const PairSide& a, const PairSide& b);

}  // namespace tumble
