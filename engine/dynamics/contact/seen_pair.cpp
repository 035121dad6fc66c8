#include "engine/dynamics/contact/seen_pair.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The pose of the smaller of two bodies, seen from the larger; of equal ones B's.
Pose relative_pose(const PairSide& a, const PairSide& b) {
  const bool a_is_smaller = a.radius < b.radius;
  const Pose& small = (a_is_smaller ? a : b).body_pose;
  const Pose& large = (a_is_smaller ? b : a).body_pose;
  const Quat back = large.q.conjugate();
  return {back._transformVector(small.x - large.x), back * small.q};
}

}  // namespace

double seen_tolerance(double margin) {
  return 0.02 * margin;
}

SeenPair look_at(const ContactKey& pair, const PairSide& a, const PairSide& b, double margin) {
  return {pair, relative_pose(a, b), margin};
}

double moved_since(const SeenPair& seen, const PairSide& a, const PairSide& b) {
  const Pose now = relative_pose(a, b);
  // No point of a body moves farther by a turn of angle t than 2 sin(t/2) times its distance.
  const double turn = 2 * (now.q * seen.relative.q.conjugate()).vec().norm();
  return (now.x - seen.relative.x).norm() + turn * std::min(a.radius, b.radius);
}

void carry_along(Contact& contact, const PairSide& a, const PairSide& b) {
  const CombinedMaterial combined = combine(a, b);
  contact.friction = combined.friction;
  contact.restitution = combined.restitution;
  contact.surface_velocity = a.belt - b.belt;
  contact.normal = a.body_pose.direction(contact.normal_a);
  contact.spin_impulse = 0;
  const Vec3 normal_b = b.body_pose.inverse_direction(contact.normal);
  const double apart = contact.normal.dot(b.body_pose.x - a.body_pose.x);
  for (ContactPoint& p : contact.used()) {
    p.gap = apart + (normal_b.dot(p.anchor_b) - contact.normal_a.dot(p.anchor_a));
    p.normal_impulse = 0;
    p.friction_impulse.setZero();
  }
}

}  // namespace tumble
