#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// A straight line between two points of the plane that triangles may not cross.
struct PlanarEdge {
  uint32_t a, b;  ///< points
  /// By how much the winding number is greater on the left of a -> b than on its right; 0 for a
  /// slit.
  int turns;
};

/// Triangles that cover a part of the plane.
struct PlanarCover {
  std::vector<Triangle> triangles;       ///< counter-clockwise, of points
  std::vector<Triangle> neighbours;      ///< across the side from corner k to k + 1; or no_index
  std::vector<std::array<int, 3>> edge;  ///< the given edge that a side is, or -1
};

/// The region of winding number 1 between edges, cut into triangles that have all edges inside it
/// as sides: a constrained triangulation, near Delaunay's, points one by one (Lawson 1977), edges
/// by swapping what crosses them (Sloan, "A fast algorithm for generating constrained Delaunay
/// triangulations", 1993). Decisions are exact for the doubles given. Loops may be many, lie within
/// each other and touch in points. No two points may be equal.
/// Nothing when edges cross, or pass through points, or winding numbers other than 0 and 1 occur.
/// O(points^2).
std::optional<PlanarCover> triangulate_graph(std::span<const Vec2> points,
                                             std::span<const PlanarEdge> edges);

}  // namespace tumble
