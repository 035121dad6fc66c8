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

void carry_along(Contact& contact, const RigidBody& a, const RigidBody& b) {
  const Material& on_a = a.shapes[contact.key.shape_a].material;
  const Material& on_b = b.shapes[contact.key.shape_b].material;
  const CombinedMaterial combined = combine(on_a, on_b);
  contact.friction = combined.friction;
  contact.restitution = combined.restitution;
  contact.normal = a.pose.direction(contact.normal_a);
  contact.surface_velocity =
      a.pose.direction(on_a.surface_velocity) - b.pose.direction(on_b.surface_velocity);
  contact.spin_impulse = 0;
  for (ContactPoint& p : contact.used()) {
    p.gap = contact.normal.dot(b.pose.point(p.anchor_b) - a.pose.point(p.anchor_a));
    p.normal_impulse = 0;
    p.friction_impulse.setZero();
  }
}

}  // namespace tumble
