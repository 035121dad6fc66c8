#pragma once
#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/contact/surface/element_gap.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// A contact point of the event stepper, closed or still open: two surface elements whose gap has
/// exact derivatives.
struct EventContact {
  ContactKey key;        ///< bodies, shapes and part of the manifold
  uint64_t feature = 0;  ///< ManifoldPoint::feature
  SurfaceElement a, b;
  Vec3 towards_b = Vec3::UnitY();  ///< the last normal, from A to B, world axes
  double friction = 0;             ///< combined [-]
  double restitution = 0;
  /// Relative velocity of B at which there is no slip (belts), world axes [m/s].
  Vec3 surface_velocity = Vec3::Zero();

  /// Accepted depth: overlap that existed when the contact began; never grows [m].
  double offset = 0;
  int impacts = 0;              ///< collisions in this tick
  bool closed = false;          ///< a force holds its gap at -offset
  bool sliding = false;         ///< closed and sliding, along `slip` at the start of the step
  Vec3 slip = Vec3::Zero();     ///< direction of the slip of B, unit, world axes
  Vec3 force = Vec3::Zero();    ///< on B, last found, world axes [N]
  Vec3 impulse = Vec3::Zero();  ///< on B over this tick [N s]

  double room(const ElementPlace& g) const { return g.gap + offset; }
};

/// Height of a bounce that rounding of positions hides; lower bounces are treated as rest [m].
inline double least_hop(const Vec3& x_world) {
  return tolerances::place_rounding + tolerances::place_rounding_share * x_world.norm();
}

/// Whether two keys name the same two shapes of the same bodies.
bool same_shapes(const ContactKey& a, const ContactKey& b);

BodyMotion motion_of(const RigidBody& body);
void put_motion(const BodyMotion& motion, RigidBody& body);
/// The gap at the bodies' present poses and velocities; very large if the elements have no unique
/// normal.
ElementGap gap_now(const EventContact& contact, std::span<const RigidBody> bodies);
/// Only the place of the gap.
ElementPlace place_now(const EventContact& contact, std::span<const RigidBody> bodies);
/// The same with x_world at the point on which the bodies push each other: the centre of the
/// particle, if one of them is a particle, with the bias of that point.
ElementGap push_gap(const EventContact& contact, std::span<const RigidBody> bodies);
ElementPlace push_place(const EventContact& contact, std::span<const RigidBody> bodies);
/// The point where two edges cross, if the contact is between edges.
std::optional<Vec3> crossing_of(const EventContact& contact, std::span<const RigidBody> bodies);
/// Whether the crossing of two edges moved far since it was at `from`, or beyond the ends of the
/// edges. Nearly parallel edges let it move fast, which the forces of one step do not follow.
bool ran_away(const EventContact& contact, const Vec3& from, std::span<const RigidBody> bodies);
/// Second derivative of the gap under the forces that are set on the bodies, without contact forces
/// [m/s2].
double free_acceleration(const EventContact& contact, const ElementGap& gap,
                         std::span<const RigidBody> bodies);

/// Tangential velocity of B relative to A, less that of belts, world axes [m/s].
Vec3 slip_of(const EventContact& contact, const ElementPlace& place,
             std::span<const RigidBody> bodies);

}  // namespace tumble
