#pragma once
#include "engine/collision/few_points.hpp"
#include "engine/collision/manifold.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <cmath>
#include <compare>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace tumble {

/// What a contact is between; the order in which contacts are kept, summed and solved. body_a is
/// the lower slot. Of a body that is paired as a whole (RigidBody::tree) the shape is 0.
struct ContactKey {
  uint32_t body_a = 0, shape_a = 0;
  uint32_t body_b = 0, shape_b = 0;
  uint64_t part = 0;  ///< Manifold::part

  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// Which shapes of two bodies, by their places in RigidBody::shapes.
struct ShapesOfPair {
  uint32_t a = 0, b = 0;
  friend auto operator<=>(const ShapesOfPair&, const ShapesOfPair&) = default;
};
/// A number that tells what belongs to two shapes, features and parts, from what belongs to others
/// of the same bodies.
uint64_t mark_of(const ShapesOfPair& shapes);

/// One point of a contact, with what the solver remembers from tick to tick.
struct ContactPoint {
  Vec3 anchor_a = Vec3::Zero();  ///< point of A's surface relative to its centre of mass, body axes
  Vec3 anchor_b = Vec3::Zero();  ///< point of B's surface, likewise
  double gap = 0;                ///< at the start of the tick; negative is penetration [m]
  uint64_t feature = 0;          ///< ManifoldPoint::feature
  double normal_force = 0;       ///< of the last sub-step [N]; warm start
  Vec3 friction_force = Vec3::Zero();    ///< on B, of the last sub-step, world axes [N]; warm start
  double normal_impulse = 0;             ///< sum over the last tick [N s]
  Vec3 friction_impulse = Vec3::Zero();  ///< on B, sum over the last tick, world axes [N s]
};

/// What the points of a contact share.
struct ContactHead {
  ContactKey key;
  ShapesOfPair shapes;            ///< that touch; where several share the contact, the first
  Vec3 normal = Vec3::UnitY();    ///< unit, from A to B, world axes
  Vec3 normal_a = Vec3::UnitY();  ///< the same in A's axes, when the narrow phase looked
  double friction = 0;            ///< combined [-]
  double restitution = 0;         ///< combined [-]
  /// Velocity of B's surface relative to A's that belts ask for, world axes [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Radius of a round surface at the contact [m]: it rolls under its anchors, which are moved
  /// along the normal instead of being carried around. 0 for flat faces, edges and corners.
  double rounding_a = 0, rounding_b = 0;
  double rolling_friction = 0, torsional_friction = 0;  ///< combined, as of Material [m]
  /// With which these resist turning: on B, of the last sub-step, world axes [N m]; warm start.
  Vec3 turning_torque = Vec3::Zero();
  /// The same on B, sum over the last part of a tick, world axes [N m s].
  Vec3 turning_impulse = Vec3::Zero();
  ClosestFeatures closest;  ///< Manifold::closest
  int count = 0;            ///< points
};

/// Where two shapes touch or are about to: up to four points that share a normal.
struct Contact : FewPoints<ContactHead, ContactPoint> {
  Contact() {}  // not cleared where it is made by resize
  /// Whether any point pressed during the last tick.
  bool pressed() const {
    for (const ContactPoint& p : used())
      if (p.normal_impulse > 0) return true;
    return false;
  }
  /// Points that pressed at the end of the last tick.
  int pressing() const {
    int count = 0;
    for (const ContactPoint& p : used()) count += p.normal_force > 0;
    return count;
  }
  /// Whether it resists turning by more than its points.
  bool resists_turning() const { return rolling_friction > 0 || torsional_friction > 0; }
};

/// Where two bodies were against each other when the narrow phase last looked at a pair of them.
/// While they hardly move, what it saw is carried along; that nothing was seen, too.
struct CachedPair {
  ContactKey pair;  ///< part is 0
  Pose relative;    ///< of the smaller side's frame (PairSide::shape_pose) in the larger one's
  /// All gaps up to here were found; where none was, there is none. Of a pair with CachedShapes: of
  /// all others of its shapes there is none [m].
  double margin = 0;
};

/// The same of two shapes that are near each other, where a body of the pair has several.
struct CachedShapes {
  ContactKey pair;  ///< CachedPair::pair
  ShapesOfPair shapes;
  Pose relative;            ///< of the sides of the pair
  double margin = 0;        ///< all gaps up to here were found, or there is none [m]
  ClosestFeatures closest;  ///< where they touch: Manifold::closest
  bool touch = false;       ///< gaps were found

  friend bool operator<(const CachedShapes& s, const CachedShapes& t) {
    return std::tie(s.pair, s.shapes) < std::tie(t.pair, t.shapes);
  }
};

/// Midway between the surfaces at point i, world axes [m].
Vec3 contact_position(const Contact& contact, int i, std::span<const RigidBody> bodies);
/// Impulse on B at point i over the last tick, world axes [N s].
Vec3 contact_impulse(const Contact& contact, int i);

/// Properties of a contact of two materials.
struct CombinedMaterial {
  double friction = 0;
  double restitution = 0;
};
/// Friction sqrt(mu_A mu_B), restitution the larger. Of two materials, or what carries their
/// coefficients.
template <class Side>
CombinedMaterial combine(const Side& a, const Side& b) {
  return {std::sqrt(a.friction * b.friction),
          a.restitution < b.restitution ? b.restitution : a.restitution};
}

/// What is known of some pairs, each list sorted.
struct ContactKnowledge {
  std::vector<Contact> contacts;     ///< by key
  std::vector<CachedPair> seen;      ///< by pair
  std::vector<CachedShapes> pieces;  ///< by pair and shapes; pairs that `seen` has

  bool empty() const { return contacts.empty() && seen.empty(); }
  void clear() {
    contacts.clear();
    seen.clear();
    pieces.clear();
  }
  void append(const ContactKnowledge& other);
  void sort();
};

}  // namespace tumble
