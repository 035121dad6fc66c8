#include "engine/dynamics/contact/seen_pair.hpp"

#include "engine/collision/shapes/polyhedral.hpp"

namespace tumble {
namespace {

bool made_of_planes(const Shape& s) {
  return s.type() == ShapeType::half_space || s.polyhedral() != nullptr;
}

/// The smaller of two bodies, seen from the other; of equal ones B.
struct Sides {
  const RigidBody& small;
  const RigidBody& large;

  Sides(const RigidBody& a, const RigidBody& b)
      : small(a.bounding_radius < b.bounding_radius ? a : b),
        large(a.bounding_radius < b.bounding_radius ? b : a) {}
  Pose relative() const {
    const Quat back = large.pose.q.conjugate();
    return {back._transformVector(small.pose.x - large.pose.x), back * small.pose.q};
  }
};

}  // namespace

bool can_be_carried(const Shape& a, const Shape& b) {
  return made_of_planes(a) && made_of_planes(b);
}

double seen_tolerance(double margin) {
  return 0.02 * margin;
}

SeenPair look_at(const ContactKey& pair, const RigidBody& a, const RigidBody& b, double margin) {
  return {pair, Sides(a, b).relative(), margin};
}

double moved_since(const SeenPair& seen, const RigidBody& a, const RigidBody& b) {
  const Sides sides(a, b);
  const Pose now = sides.relative();
  // No point of a body moves farther by a turn of angle t than 2 sin(t/2) times its distance.
  const double turn = 2 * (now.q * seen.relative.q.conjugate()).vec().norm();
  return (now.x - seen.relative.x).norm() + turn * sides.small.bounding_radius;
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
