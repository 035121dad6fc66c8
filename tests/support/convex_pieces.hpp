#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

/// Whether convex bodies partition a solid, by definitions that know nothing of how they were made.
namespace tumble::pieces {

/// How far a vertex lies over a face of its own polyhedron at most [m].
inline double worst_bulge(const ConvexPolyhedron& p) {
  double worst = 0;
  for (const Plane& plane : p.planes)
    for (const Vec3& v : p.vertices) worst = std::max(worst, plane.distance(v));
  return worst;
}

/// How far apart the shadows of two bodies along a direction are; negative when they overlap [m].
inline double gap_along(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const Vec3& way) {
  const double length = way.norm();
  if (!(length > 1e-9)) return -std::numeric_limits<double>::infinity();
  double low_a = std::numeric_limits<double>::infinity(), high_a = -low_a, low_b = low_a,
         high_b = -low_a;
  for (const Vec3& v : a.vertices) {
    low_a = std::min(low_a, v.dot(way));
    high_a = std::max(high_a, v.dot(way));
  }
  for (const Vec3& v : b.vertices) {
    low_b = std::min(low_b, v.dot(way));
    high_b = std::max(high_b, v.dot(way));
  }
  return std::max(low_b - high_a, low_a - high_b) / length;
}

/// The depth by which two convex bodies overlap [m], by the separating axis theorem: negative or 0
/// when they do not. Stops once it is no more than `enough`.
inline double overlap_depth(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double enough) {
  double gap = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3 && -gap > enough; ++k) gap = std::max(gap, gap_along(a, b, Vec3::Unit(k)));
  for (const ConvexPolyhedron* p : {&a, &b})
    for (const Plane& plane : p->planes) {
      if (-gap <= enough) return -gap;
      gap = std::max(gap, gap_along(a, b, plane.normal));
    }
  for (const PolyhedronEdge& e : a.edges)
    for (const PolyhedronEdge& f : b.edges) {
      if (-gap <= enough) return -gap;
      const Vec3 u = a.vertices[e.vertices[1]] - a.vertices[e.vertices[0]],
                 v = b.vertices[f.vertices[1]] - b.vertices[f.vertices[0]];
      gap = std::max(gap, gap_along(a, b, u.normalized().cross(v.normalized())));
    }
  return -gap;
}

}  // namespace tumble::pieces
