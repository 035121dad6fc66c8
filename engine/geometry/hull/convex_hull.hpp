#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <span>

namespace tumble {

struct HullOptions {
  /// Facets whose corners lie within this times the extent of one plane are merged, and points no
  /// further than it outside are left out. 1e-9 suits coordinates in double; 1e-6 those that were
  /// stored in single precision.
  double relative_tolerance = 1e-9;
};

struct ConvexHull {
  ConvexPolyhedron polyhedron;
  std::vector<uint32_t> source;  ///< for each vertex, the input point that it is
  double tolerance = 0;          ///< every input point is within this of the hull [m]
};

/// Convex hull of any points: Quickhull (Barber, Dobkin & Huhdanpaa 1996) whose visibility
/// decisions are exact (predicates/orientation), so that coplanar, collinear and repeated points
/// cannot break its topology; near-coplanar facets are merged afterwards.
/// Errors: not finite; fewer than four points; all points equal, collinear, or "flat": their
/// thickness across the best plane is below four times the tolerance.
Result<ConvexHull> convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

/// Checks a hull against the points it should hold: indices and twins consistent, Euler's formula
/// V - E + F = 2, every edge convex, every face loop convex, every vertex on its planes and every
/// point (and vertex) inside all of them, within `epsilon` [m]. The error names what fails first.
/// Costs points times faces.
Status check_hull(const ConvexPolyhedron& hull, std::span<const Vec3> points, double epsilon);

}  // namespace tumble
