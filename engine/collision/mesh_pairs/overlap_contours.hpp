#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <vector>

namespace tumble {

/// Where an edge of one surface passes through a triangle of the other.
struct ContourNode {
  bool of_b;  ///< the edge is B's and the triangle A's
  uint32_t edge, triangle;
  double s;       ///< place on the edge, 0 at its first vertex, 1 at its second
  Vec3 x;         ///< query frame
  bool entering;  ///< the edge, run from its first vertex, goes in there

  bool same_edge(const ContourNode& n) const { return of_b == n.of_b && edge == n.edge; }
};

/// A straight piece of the curve in which two surfaces cross, along the cross product of the
/// normals of A and B: the patch of A inside B lies on its left, seen from outside A.
struct ContourSegment {
  uint32_t from, to;  ///< nodes
};

/// The curves in which two surfaces cross. Where `sound`, they are closed: every node ends one
/// segment and starts another.
struct OverlapContours {
  std::vector<ContourNode> nodes;  ///< ascending by side, edge and s
  std::vector<ContourSegment> segments;
  bool sound = true;

  bool crossing() const { return !nodes.empty(); }
};

/// Finds the contours; `pairs` holds at least all pairs of triangles that cross. Each pair of an
/// edge and a triangle is decided once, with the same numbers for all triangles around the edge and
/// ties broken by vertex number, so that contours close but for rounding.
void find_contours(const PlacedSurface& A, const PlacedSurface& B,
                   std::span<const TriangleIds> pairs, OverlapContours& out);

}  // namespace tumble
