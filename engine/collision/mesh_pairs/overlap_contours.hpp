#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <vector>

namespace tumble {

/// A point at which an edge of one surface passes through a triangle of the other.
struct ContourNode {
  bool of_b;  ///< the edge is B's and the triangle A's
  uint32_t edge, triangle;
  double s;       ///< parameter along the edge, 0 at its first vertex, 1 at its second
  Vec3 x;         ///< query frame
  bool entering;  ///< the edge enters the other solid there, if followed from its first vertex

  bool same_edge(const ContourNode& n) const { return of_b == n.of_b && edge == n.edge; }
};

/// A straight segment of the curve in which two surfaces cross, in the direction of the cross
/// product of the normals of A and B: seen from outside A, the patch of A inside B lies on its
/// left.
struct ContourSegment {
  uint32_t from, to;  ///< indices of nodes
};

/// The curves in which two surfaces cross. If `sound`, they are closed: every node ends one segment
/// and starts another.
struct OverlapContours {
  std::vector<ContourNode> nodes;  ///< ascending by side, edge and s
  std::vector<ContourSegment> segments;
  bool sound = true;

  bool crossing() const { return !nodes.empty(); }
};

/// Finds the contours; `pairs` must hold all pairs of triangles that cross, and may hold more. Each
/// pair of an edge and a triangle is decided once, with the same numbers for all triangles at the
/// edge, and ties are broken by vertex index, so that contours close, except for rounding.
void find_contours(const PlacedSurface& A, const PlacedSurface& B,
                   std::span<const TriangleIds> pairs, OverlapContours& out);

}  // namespace tumble
