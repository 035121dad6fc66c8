#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/event/pieces.hpp"

#include <span>
#include <vector>

namespace tumble {

/// A pair of shapes that may meet.
struct EventPair {
  ShapeRef a, b;
  double margin = 0;  ///< contacts are sought up to this gap [m]
  PairGap gap = {};   ///< when contacts were last found; of meshes, the least gap of their pieces
  double offset = 0;  ///< greatest accepted depth of its contacts [m]
  /// Range of its contacts in the list last found.
  size_t first_contact = 0, contacts = 0;
};

/// The shapes of a pair with their world poses.
struct PairShapes {
  const RigidBody &a, &b;
  const BodyShape &sa, &sb;
  Pose at_a, at_b;

  PairShapes(const EventPair& p, std::span<const RigidBody> bodies)
      : a(bodies[p.a.body]),
        b(bodies[p.b.body]),
        sa(a.shapes[p.a.shape]),
        sb(b.shapes[p.b.shape]),
        at_a(a.pose * sa.pose),
        at_b(b.pose * sb.pose) {}
  double size() const { return std::min(sa.shape->bounding_radius(), sb.shape->bounding_radius()); }
};

/// The contacts of two shapes at their present poses as manifolds; sets the pair's gap.
void find_manifolds(const PairShapes& shapes, EventPair& pair, NarrowPhase narrow_phase,
                    const HierarchyKind* hierarchy, std::vector<Manifold>& out);
/// A manifold of one point: the nearest or deepest points of a gap.
Manifold nearest_point(const PairGap& gap);

/// The pieces of a pair that may be within `reach` [m] of each other at the bodies' present poses.
void pieces_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double reach,
                    const HierarchyKind* hierarchy, std::vector<PiecePair>& out);
/// The gap of two pieces at the bodies' present poses; `towards_b` as in pair_gap().
PairGap gap_of_pieces(const EventPair& pair, const PiecePair& pieces,
                      std::span<const RigidBody> bodies, double margin, const Vec3& towards_b);
/// The least gap of all pieces of a pair at the bodies' present poses.
PairGap gap_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double margin,
                    const HierarchyKind* hierarchy);
/// Separation of two pieces along a direction, world axes [m].
double separation_of_pieces(const EventPair& pair, const PiecePair& pieces,
                            std::span<const RigidBody> bodies, const Vec3& n);

}  // namespace tumble
