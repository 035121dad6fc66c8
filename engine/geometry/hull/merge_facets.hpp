#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"
#include "engine/geometry/hull/quickhull.hpp"

namespace tumble {

/// Polygonal facets of a simplicial hull, as loops of input points with their planes.
struct MergedFacets {
  std::vector<std::vector<uint32_t>> loops;
  std::vector<Plane> planes;
};

/// Joins neighbouring triangles whose corners lie within `tolerance` [m] of the plane of the
/// largest among them, which becomes the plane of the facet; vertices inside a facet or on a
/// straight edge between two are dropped. Where that would give an outline that is not one
/// convex loop, less is joined.
MergedFacets merge_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                          double tolerance);

/// Every triangle a facet of its own.
MergedFacets separate_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles);

}  // namespace tumble
