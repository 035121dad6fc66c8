#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"
#include "engine/geometry/hull/quickhull.hpp"

namespace tumble {

/// Polygonal facets of a simplicial hull: corners of facet f, as input points, are
/// corners[first[f]] .. corners[first[f + 1] - 1], counter-clockwise from outside.
struct MergedFacets {
  std::vector<uint32_t> first;  ///< size facets + 1
  std::vector<uint32_t> corners;
  std::vector<Plane> planes;
};

/// Joins neighbouring triangles whose corners lie within `tolerance` [m] of the plane of the
/// largest among them, which becomes the plane of the facet. Corners at which only two facets meet
/// are left out, and slivers that have no more than two others; both lie within the tolerance of
/// the edge that replaces them. Every facet is convex within the tolerance. Where all that cannot
/// be had less is joined; in the end each triangle is a facet. Facets come in the order of their
/// largest triangles.
MergedFacets merge_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                          double tolerance);

/// Every triangle a facet of its own.
MergedFacets separate_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                             double tolerance);

}  // namespace tumble
