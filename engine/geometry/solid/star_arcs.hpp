#pragma once
#include "engine/geometry/hierarchy/triangle_decisions.hpp"

#include <vector>

namespace tumble {

/// A triangle seen from one of its corners: the arc between the directions to the other two on the
/// unit sphere, in a box. Two triangles have no point but the corner in common unless arcs meet.
struct StarArc {
  Vec3 low, high;
  uint32_t triangle;
  uint8_t corner;

  bool apart(const StarArc& other) const {
    return (low.array() > other.high.array()).any() || (other.low.array() > high.array()).any();
  }
};

StarArc star_arc(const TriangleMesh& mesh, uint32_t triangle, uint8_t corner);

/// What may clash around a vertex in which many triangles meet.
struct StarPairs {
  /// With only that vertex in common, their arcs' boxes meeting.
  std::vector<TriangleIds> loose;
  /// With a side in common at that vertex, one folded onto the other, or all corners. Of those that
  /// share more than two corners, or a side between two large stars, each vertex reports some: the
  /// lowest common one counts.
  std::vector<TriangleIds> folded;
  bool complete = true;  ///< not ended at the limit
};

/// In O(n log n) plus what is found: pairs of arcs by a tree of boxes, which leaves out nodes whose
/// triangles all share another vertex; folded triangles by sorting around each side, exactly.
StarPairs large_star_pairs(const TriangleMesh& mesh, uint32_t vertex, std::vector<StarArc> arcs,
                           size_t limit);

/// The side p-q with apex a and the same with apex b: folded onto each other.
bool folded_at(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

}  // namespace tumble
