#pragma once
#include "engine/collision/narrow_phase.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/element_gap.hpp"

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

  double room(const ElementGap& g) const { return g.gap + offset; }
};

/// A pair of shapes that may meet.
struct EventPair {
  ShapeRef a, b;
  double margin = 0;  ///< gaps up to this are of interest [m]
};

/// Surfaces nearer than this touch [m].
inline constexpr double touch_distance = 1e-9;

/// The contacts of the pairs at the bodies' present poses; what continues one of `before` keeps its
/// offset, counts and forces. A contact that is new and overlaps by more than `touch_distance` has
/// its depth as offset.
std::vector<EventContact> find_event_contacts(std::span<const RigidBody> bodies,
                                              std::span<const EventPair> pairs,
                                              NarrowPhase narrow_phase,
                                              const HierarchyKind* hierarchy,
                                              std::span<const EventContact> before);

BodyMotion motion_of(const RigidBody& body);
/// The gap at the bodies' present poses and velocities.
ElementGap gap_now(const EventContact& contact, std::span<const RigidBody> bodies);

}  // namespace tumble
