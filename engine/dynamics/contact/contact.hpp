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

/// The two shapes of a contact, and which of their contacts it is. Contacts are stored, summed and
/// solved in the order of their keys. body_a is the lower slot. The shape of a body that is paired
/// as a whole (RigidBody::tree) is 0.
struct ContactKey {
  uint32_t body_a = 0, shape_a = 0;
  uint32_t body_b = 0, shape_b = 0;
  uint64_t part = 0;  ///< Manifold::part

  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// Two shapes of two bodies, by their indices in RigidBody::shapes.
struct ShapesOfPair {
  uint32_t a = 0, b = 0;
  friend auto operator<=>(const ShapesOfPair&, const ShapesOfPair&) = default;
};
/// A number by which features and parts of manifolds of these two shapes differ from those of other
/// shapes of the same bodies.
uint64_t mark_of(const ShapesOfPair& shapes);

/// One point of a contact, with what the solver remembers from tick to tick.
struct ContactPoint {
  Vec3 anchor_a = Vec3::Zero();  ///< point of A's surface relative to its centre of mass, body axes
  Vec3 anchor_b = Vec3::Zero();  ///< point of B's surface, likewise
  double gap = 0;  ///< along the normal, at the start of the tick; negative is penetration [m]
  uint64_t feature = 0;                  ///< ManifoldPoint::feature
  double normal_force = 0;               ///< of the last sub-step [N]; warm start
  Vec3 friction_force = Vec3::Zero();    ///< on B, of the last sub-step, world axes [N]; warm start
  double normal_impulse = 0;             ///< sum over the last tick [N s]
  Vec3 friction_impulse = Vec3::Zero();  ///< on B, sum over the last tick, world axes [N s]
};

/// What the points of a contact share.
struct ContactHead {
  ContactKey key;
  /// The shapes that touch; where several pairs of shapes share the contact, the first pair.
  ShapesOfPair shapes;
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, world axes
  /// The same in A's body axes, as of when the narrow phase last ran.
  Vec3 normal_a = Vec3::UnitY();
  double friction = 0;     ///< combined [-]
  double restitution = 0;  ///< combined [-]
  /// Velocity of B's surface relative to A's that the materials prescribe (belts), world axes
  /// [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Radius of a round surface at the contact [m]: the surface rolls under its anchors, which stay
  /// on the normal between the bodies instead of turning with the body. 0 for flat faces, edges and
  /// corners.
  double rounding_a = 0, rounding_b = 0;
  double rolling_friction = 0, torsional_friction = 0;  ///< combined lever arms, see Material [m]
  /// Torque of rolling and torsional friction on B, of the last sub-step, world axes [N m]; warm
  /// start.
  Vec3 turning_torque = Vec3::Zero();
  /// Its angular impulse on B over the last part of a tick, world axes [N m s].
  Vec3 turning_impulse = Vec3::Zero();
  ClosestFeatures closest;  ///< Manifold::closest
  int count = 0;            ///< number of points
};

/// Where two shapes touch or are about to: up to four points that share a normal.
struct Contact : FewPoints<ContactHead, ContactPoint> {
  Contact() {}  // leaves the points as they are: vectors of contacts are resized often
  /// Whether any point pressed during the last tick.
  bool pressed() const {
    for (const ContactPoint& p : used())
      if (p.normal_impulse > 0) return true;
    return false;
  }
  /// How many points pressed at the end of the last tick.
  int pressing() const {
    int count = 0;
    for (const ContactPoint& p : used()) count += p.normal_force > 0;
    return count;
  }
  /// Whether rolling or torsional friction acts, beside the forces of the points.
  bool resists_turning() const { return rolling_friction > 0 || torsional_friction > 0; }
};

/// Relative pose of two bodies when the narrow phase last ran on them. While they hardly move
/// relative to each other its result is carried along, also where it found no contact.
struct CachedPair {
  ContactKey pair;  ///< part is 0
  Pose relative;    ///< pose of the smaller side's frame (PairSide::shape_pose) in the larger one's
  /// All gaps up to this were found; where none was, the shapes are farther apart than this. For a
  /// pair with CachedShapes: all pairs of its shapes without a CachedShapes are farther apart than
  /// this [m].
  double margin = 0;
};

/// The same for two shapes that are near each other, where a body of the pair has several shapes.
struct CachedShapes {
  ContactKey pair;  ///< CachedPair::pair
  ShapesOfPair shapes;
  Pose relative;  ///< pose of the sides of the pair, as in CachedPair
  /// All gaps up to this were found; where none was, the shapes are farther apart [m]
  double margin = 0;
  ClosestFeatures closest;  ///< Manifold::closest, if they touch
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
/// Friction sqrt(mu_A mu_B), restitution the larger one. `Side` is Material or anything with its
/// coefficients.
template <class Side>
CombinedMaterial combine(const Side& a, const Side& b) {
  return {std::sqrt(a.friction * b.friction),
          a.restitution < b.restitution ? b.restitution : a.restitution};
}

/// Contacts of some pairs, and what is remembered of the last narrow phase on them; each list is
/// sorted.
struct ContactKnowledge {
  std::vector<Contact> contacts;     ///< by key
  std::vector<CachedPair> seen;      ///< by pair
  std::vector<CachedShapes> pieces;  ///< by pair and shapes; their pairs are in `seen`

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
