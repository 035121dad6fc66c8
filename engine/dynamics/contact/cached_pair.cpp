#include "engine/dynamics/contact/cached_pair.hpp"

#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The poses of the smaller of two sides, and of the larger.
struct TwoPoses {
  const Pose& small;
  const Pose& large;
  TwoPoses(const PairSide& a, const PairSide& b)
      : small((smaller_first(a, b) ? a : b).shape_pose),
        large((smaller_first(a, b) ? b : a).shape_pose) {}

  /// Position and orientation of the smaller side in the frame of the larger one.
  Vec3 place() const { return large.q.conjugate() * (small.x - large.x); }
  Quat orientation() const { return large.q.conjugate() * small.q; }
};

}  // namespace

Pose relative_pose(const PairSide& a, const PairSide& b) {
  const TwoPoses poses(a, b);
  return {poses.place(), poses.orientation()};
}

double seen_tolerance(double margin) {
  return tolerances::carried_of_margin * margin;
}

CachedPair look_at(const ContactKey& pair, const PairSide& a, const PairSide& b, double margin) {
  return {pair, relative_pose(a, b), margin};
}

double moved_since(const CachedPair& seen, const PairSide& a, const PairSide& b, double enough) {
  const TwoPoses now(a, b);
  const double shift = (now.place() - seen.relative.x).norm();
  if (shift > enough) return std::numeric_limits<double>::infinity();
  // By a rotation of angle t no point of a shape moves farther than 2 sin(t/2) times its distance.
  const double turn = 2 * (now.orientation() * seen.relative.q.conjugate()).vec().norm();
  return shift + turn * std::min(a.shape_radius, b.shape_radius);
}

void carry_along(Contact& contact, const PairSide& a, const PairSide& b) {
  take_materials(contact, a, b);
  contact.normal = a.body_pose.direction(contact.normal_a);
  contact.turning_impulse.setZero();
  const Vec3 normal_b = b.body_pose.inverse_direction(contact.normal);
  const double apart = contact.normal.dot(b.body_pose.x - a.body_pose.x);
  for (ContactPoint& p : contact.used()) {
    p.gap = apart + (normal_b.dot(p.anchor_b) - contact.normal_a.dot(p.anchor_a));
    p.normal_impulse = 0;
    p.friction_impulse.setZero();
  }
}

}  // namespace tumble
