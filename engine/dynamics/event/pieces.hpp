#pragma once
#include "engine/collision/contact_query.hpp"
#include "engine/dynamics/event/pair_gap.hpp"

namespace tumble {

/// A convex piece of each of two shapes: a triangle of a mesh by its index, or no_index for the
/// whole of another shape, or for a mesh against a half-space.
struct PiecePair {
  uint32_t a = no_index, b = no_index;
};

/// The pairs of pieces that may be within `reach` [m] of each other, ascending; degenerate
/// triangles are left out. `hierarchy` as in ContactQuery.
void near_pieces(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double reach, const HierarchyKind* hierarchy, std::vector<PiecePair>& out);

/// pair_gap() of two pieces. Triangles have two sides and no inside: a shape that has passed one by
/// less than half of its own size is pushed back, so that open sheets hold on both sides.
PairGap piece_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                  const PiecePair& pieces, double margin, const Vec3& towards_b);

/// separation_along() of two pieces.
double piece_separation(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const PiecePair& pieces, const Vec3& n);

/// The least gap of all pieces, and the pieces that have it. Not near if all are farther apart than
/// the margin.
struct NearestPieces {
  PairGap gap;
  PiecePair pieces;
};
NearestPieces nearest_pieces(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                             double margin, const HierarchyKind* hierarchy);

}  // namespace tumble
