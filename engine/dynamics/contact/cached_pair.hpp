#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/pair_side.hpp"

#include <limits>

namespace tumble {

/// Contacts of two bodies may be carried along while the bodies hardly move relative to each other,
/// if both surfaces are made of planes. A round surface rolls under its contacts, so of a pair with
/// one only a separation can be remembered.
///
/// The relative motion of the points of a pair beyond which the narrow phase must run again [m];
/// `margin` is that of the pair (PairSide::margin) [m].
double seen_tolerance(double margin);

/// Records that the narrow phase has just found all gaps up to `margin` between two bodies.
CachedPair look_at(const ContactKey& pair, const PairSide& a, const PairSide& b, double margin);

/// An upper bound on how far any point of the smaller side has moved relative to the larger one
/// since then [m]; infinity where the bound is more than `enough`, which is cheaper to decide.
double moved_since(const CachedPair& seen, const PairSide& a, const PairSide& b,
                   double enough = std::numeric_limits<double>::infinity());

/// Motion of the smaller side of a pair since the narrow phase ran, in the frame of the larger one.
class MotionSince {
 public:
  /// From the relative_pose of the sides then to that of now.
  MotionSince(const Pose& then, const Pose& now)
      : back_(then * now.inverse()), turn_(2 * back_.q.vec().norm()) {}

  /// How far a point that is now at x has moved, whichever side it belongs to [m].
  double shift(const Vec3& x) const { return (x - back_.point(x)).norm(); }
  /// A bound on that for all points within `radius` of x [m].
  double shift(const Vec3& x, double radius) const { return shift(x) + turn_ * radius; }

 private:
  Pose back_;  ///< maps present positions to those of then
  /// 2 sin(angle / 2): displacement by the rotation for a unit distance from its axis.
  double turn_;
};

/// The pose of the smaller side in the frame of the larger one; of equally large sides, of B in A.
Pose relative_pose(const PairSide& a, const PairSide& b);
/// Whether A is the smaller side; of equally large ones B is.
inline bool smaller_first(const PairSide& a, const PairSide& b) {
  return a.shape_radius < b.shape_radius;
}

/// Sets what a contact takes from the materials of its two shapes; the forces of its points must be
/// set before. Rolling and torsional friction represent the width of the contact patch, which a
/// point or line contact does not resolve; three or more points that press span a patch, which
/// resists turning by where its forces act.
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

/// Moves a contact with the bodies to their present poses: its points stay fixed on both bodies,
/// its normal turns with A, impulses of the tick start from zero. The gaps are exact where planes
/// of A meet corners of B; in general their error is of second order in the relative motion.
void carry_along(Contact& contact, const PairSide& a, const PairSide& b);

}  // namespace tumble
