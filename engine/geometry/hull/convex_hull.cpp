#include "engine/geometry/hull/convex_hull.hpp"

#include "engine/geometry/hull/merge_facets.hpp"
#include "engine/geometry/hull/quickhull.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Numbers the points that the loops use, in ascending order, and builds the polyhedron.
Result<ConvexPolyhedron> assemble(std::span<const Vec3> points, MergedFacets facets,
                                  std::vector<uint32_t>& source) {
  source.clear();
  for (const auto& loop : facets.loops) source.insert(source.end(), loop.begin(), loop.end());
  std::sort(source.begin(), source.end());
  source.erase(std::unique(source.begin(), source.end()), source.end());
  std::vector<Vec3> vertices;
  vertices.reserve(source.size());
  for (uint32_t p : source) vertices.push_back(points[p]);
  for (auto& loop : facets.loops) {
    for (uint32_t& v : loop) {
      v = uint32_t(std::lower_bound(source.begin(), source.end(), v) - source.begin());
    }
  }
  auto polyhedron = make_polyhedron(std::move(vertices), std::move(facets.loops));
  if (polyhedron) polyhedron->planes = std::move(facets.planes);
  return polyhedron;
}

bool euler_holds(const ConvexPolyhedron& p) {
  return p.vertices.size() + p.face_count() == p.edges.size() + 2;
}

}  // namespace

Result<ConvexHull> convex_hull(std::span<const Vec3> points, const HullOptions& options) {
  Aabb box;
  double largest = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if (!p.allFinite()) {
      return Error{ErrorCode::invalid_argument,
                   fmt::format("point {} is ({}, {}, {}), not finite", i, p.x(), p.y(), p.z()),
                   {},
                   {}};
    }
    box.include(p);
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (points.size() < 4) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("a convex hull needs at least 4 points, got {}", points.size()),
                 {},
                 {}};
  }
  // Coordinates themselves are only good to their last place.
  const double rounding = 4e-15 * largest;
  const double tolerance = std::max(options.relative_tolerance * box.extent().norm(), rounding);
  const auto triangles = quickhull(points, tolerance);
  if (!triangles) return triangles.error();

  ConvexHull out;
  out.tolerance = 2 * tolerance;
  auto merged = assemble(points, merge_facets(points, *triangles, tolerance), out.source);
  if (!merged || !euler_holds(*merged)) {
    // Merging met a facet that it could not outline: the triangles themselves are always right.
    merged = assemble(points, separate_facets(points, *triangles), out.source);
    if (!merged) return merged.error();
  }
  out.polyhedron = std::move(*merged);
  return out;
}

}  // namespace tumble
