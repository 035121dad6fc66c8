#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <span>

namespace tumble {

struct HullOptions {
  /// Facets whose corners lie within this times the extent of one plane are merged, and points no
  /// further than it outside are left out (0 to 0.01). 1e-9 suits coordinates in double; 1e-6 those
  /// that were stored in single precision.
  double relative_tolerance = 1e-9;
};

struct ConvexHull {
  ConvexPolyhedron polyhedron;
  std::vector<uint32_t> source;  ///< for each vertex, the input point that it is
  double tolerance = 0;          ///< every input point is within this of the hull [m]
};

/// Convex hull of any points: Quickhull (Barber, Dobkin & Huhdanpaa, "The quickhull algorithm for
/// convex hulls", 1996) whose visibility decisions are exact (predicates/orientation), so that
/// coplanar, collinear and repeated points cannot break its topology; near-coplanar facets are
/// merged afterwards. The tolerance is relative_tolerance times the diagonal of the bounding box,
/// or 4e-15 times the largest coordinate where that is more. Vertices are input points, in their
/// order; the same points in the same order give the same hull, bit by bit.
/// Errors: not finite; fewer than four points; all points "coincide", are "collinear" or "flat",
/// within four times the tolerance of one point, line or plane; the largest coordinate is outside
/// 1e-40 m to 1e40 m; relative_tolerance is not from 0 to 0.01.
Result<ConvexHull> convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

/// Checks a hull against the points it should hold: indices and twins consistent, connected,
/// Euler's formula V - E + F = 2, every face loop convex, every vertex on its planes and every
/// point (and vertex) inside all of them, which includes that every edge is convex, within
/// `epsilon` [m]. The error names what fails first. The cost grows little faster than points and
/// faces, and with the square of the corners of each face.
Status check_hull(const ConvexPolyhedron& hull, std::span<const Vec3> points, double epsilon);

}  // namespace tumble
