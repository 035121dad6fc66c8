#pragma once
#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/contact/surface/element_gap.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// A point of contact, or of contact to come, of the event stepper: two surface elements with a gap
/// that has exact derivatives.
struct EventContact {
  ContactKey key;        ///< bodies, shapes and part of the manifold
  uint64_t feature = 0;  ///< ManifoldPoint::feature
  SurfaceElement a, b;
  Vec3 towards_b = Vec3::UnitY();  ///< the last normal, world axes
  double friction = 0;             ///< combined [-]
  double restitution = 0;
  /// Relative velocity of B at which it does not slip (belts), world axes [m/s].
  Vec3 surface_velocity = Vec3::Zero();

  /// Depth that is accepted since it was there when the contact began [m]: never grows.
  double offset = 0;
  int impacts = 0;              ///< in this tick
  bool closed = false;          ///< held at its offset
  bool sliding = false;         ///< closed and sliding, along `slip` at the start of the step
  Vec3 slip = Vec3::Zero();     ///< unit, world axes
  Vec3 force = Vec3::Zero();    ///< on B, the last found, world axes [N]
  Vec3 impulse = Vec3::Zero();  ///< on B over this tick [N s]

  double room(const ElementPlace& g) const { return g.gap + offset; }
};

/// What bounces lower than this stays: the digits of a place do not tell whether it left [m].
inline double least_hop(const Vec3& x_world) {
  return tolerances::place_rounding + tolerances::place_rounding_share * x_world.norm();
}

/// Whether two keys name the same two shapes.
bool same_shapes(const ContactKey& a, const ContactKey& b);

BodyMotion motion_of(const RigidBody& body);
void put_motion(const BodyMotion& motion, RigidBody& body);
/// The gap at the bodies' present poses and velocities; very large where the elements have none.
ElementGap gap_now(const EventContact& contact, std::span<const RigidBody> bodies);
/// Its place alone.
ElementPlace place_now(const EventContact& contact, std::span<const RigidBody> bodies);
/// The same with the point at which the two push each other: where one is a particle its centre,
/// at which it is felt, with the bias that belongs there.
ElementGap push_gap(const EventContact& contact, std::span<const RigidBody> bodies);
ElementPlace push_place(const EventContact& contact, std::span<const RigidBody> bodies);
/// Where two edges cross, if a contact is such.
std::optional<Vec3> crossing_of(const EventContact& contact, std::span<const RigidBody> bodies);
/// Whether it ran far along the edges since it was at `from`, or beyond their ends: of edges that
/// are nearly along each other it soon does, and forces through a step know nothing of it.
bool ran_away(const EventContact& contact, const Vec3& from, std::span<const RigidBody> bodies);
/// Second derivative of the gap under the bodies' forces, as they are set, without any push [m/s2].
double free_acceleration(const EventContact& contact, const ElementGap& gap,
                         std::span<const RigidBody> bodies);

/// Velocity of B along the tangent plane, less what belts ask for [m/s], world axes.
Vec3 slip_of(const EventContact& contact, const ElementPlace& place,
             std::span<const RigidBody> bodies);

}  // namespace tumble
