#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// A triangle of the simplicial hull that Quickhull leaves, before facets are merged.
struct HullTriangle {
  Triangle vertices;                   ///< input points, counter-clockwise from outside
  std::array<uint32_t, 3> neighbours;  ///< triangle across the side from corner k to corner k + 1
};

/// Triangles whose union is the exact convex hull of a subset of the points; no other point is
/// further than `tolerance` [m] from that hull, and no two corners are nearer to each other than
/// that. Each neighbour is an index into the result.
/// Finite coordinates only; each zero or of magnitude 1e-75 to 1e45, and `tolerance` at least
/// 4e-15 times the largest.
/// Errors: all points within 4 `tolerance` of one point, line or plane.
Result<std::vector<HullTriangle>> quickhull(std::span<const Vec3> points, double tolerance);

}  // namespace tumble
