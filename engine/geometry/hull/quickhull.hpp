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

/// Triangles whose union is the exact convex hull of a subset of the points; all others lie at most
/// `tolerance` [m] outside it. Each neighbour is an index into the result.
/// Errors: all points within 4 `tolerance` of one point, line or plane.
Result<std::vector<HullTriangle>> quickhull(std::span<const Vec3> points, double tolerance);

}  // namespace tumble
