#include "engine/geometry/hull/convex_hull.hpp"

#include "engine/geometry/hull/merge_facets.hpp"
#include "engine/geometry/hull/quickhull.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Range of the largest coordinate [m] in which products of three differences are exact.
constexpr double hull_smallest = 1e-40, hull_largest = 1e40;
/// Coordinates below this times the largest count as zero, for the same reason [-].
constexpr double hull_negligible = 1e-30;
/// Relative rounding error of the coordinates themselves [-].
constexpr double hull_rounding = 4e-15;

Error bad_hull_input(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

Status check_hull_input(std::span<const Vec3> points, const HullOptions& options) {
  if (!(options.relative_tolerance >= 0 && options.relative_tolerance <= 0.01)) {
    return bad_hull_input(
        fmt::format("the relative tolerance of a hull must be from 0 to 0.01, got {}",
                    options.relative_tolerance));
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    if (!p.allFinite()) {
      return bad_hull_input(
          fmt::format("point {} is ({}, {}, {}), not finite", i, p.x(), p.y(), p.z()));
    }
  }
  if (points.size() < 4) {
    return bad_hull_input(
        fmt::format("a convex hull needs at least 4 points, got {}", points.size()));
  }
  if (points.size() >= no_index) {
    return bad_hull_input(fmt::format("{} points are too many for a convex hull", points.size()));
  }
  return {};
}

/// The points used by triangles or facets, ascending; the indices in these are renumbered to match.
template <class Corners>
std::vector<uint32_t> compact(size_t points, Corners&& for_each_corner) {
  std::vector<uint32_t> number(points, no_index), used;
  for_each_corner([&](uint32_t& v) { number[v] = 0; });
  for (uint32_t v = 0; v < points; ++v) {
    if (number[v] == no_index) continue;
    number[v] = uint32_t(used.size());
    used.push_back(v);
  }
  for_each_corner([&](uint32_t& v) { v = number[v]; });
  return used;
}

std::vector<Vec3> pick(std::span<const Vec3> points, const std::vector<uint32_t>& which) {
  std::vector<Vec3> out;
  out.reserve(which.size());
  for (uint32_t v : which) out.push_back(points[v]);
  return out;
}

/// The polyhedron of facets over `points`; `used` receives the points that it keeps.
Result<ConvexPolyhedron> assemble(std::span<const Vec3> points, MergedFacets facets,
                                  std::vector<uint32_t>& used) {
  used = compact(points.size(), [&](const auto& use) {
    for (uint32_t& v : facets.corners) use(v);
  });
  return make_polyhedron(pick(points, used), std::move(facets.first), std::move(facets.corners),
                         std::move(facets.planes));
}

bool euler_holds(const ConvexPolyhedron& p) {
  return p.vertices.size() + p.face_count() == p.edges.size() + 2;
}

/// The hull of points whose coordinates are in the range of the exact predicates.
Result<ConvexHull> hull_of(std::span<const Vec3> points, double tolerance) {
  auto triangles = quickhull(points, tolerance);
  if (!triangles) return triangles.error();
  const std::vector<uint32_t> corners = compact(points.size(), [&](const auto& use) {
    for (HullTriangle& t : *triangles) {
      for (uint32_t& v : t.vertices) use(v);
    }
  });
  const std::vector<Vec3> vertices = pick(points, corners);
  ConvexHull out;
  out.tolerance = 2 * tolerance;
  auto merged = assemble(vertices, merge_facets(vertices, *triangles, tolerance), out.source);
  if (!merged || !euler_holds(*merged)) {
    // Two facets share more than one edge: unmerged triangles are used instead, which are always
    // valid.
    merged = assemble(vertices, separate_facets(vertices, *triangles, tolerance), out.source);
    if (!merged) return merged.error();
  }
  for (uint32_t& v : out.source) v = corners[v];
  out.polyhedron = std::move(*merged);
  return out;
}

}  // namespace

Result<ConvexHull> convex_hull(std::span<const Vec3> points, const HullOptions& options) {
  if (const Status ok = check_hull_input(points, options); !ok) return ok.error();
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const double largest = std::max(box.max.cwiseAbs().maxCoeff(), box.min.cwiseAbs().maxCoeff());
  if (largest > 0 && !(largest >= hull_smallest && largest <= hull_largest)) {
    return bad_hull_input(fmt::format("coordinates up to {:.3g} m are outside the {:.0e} to "
                                      "{:.0e} m that a convex hull can decide exactly",
                                      largest, hull_smallest, hull_largest),
                          "use other units");
  }
  const double tolerance =
      std::max(options.relative_tolerance * box.extent().norm(), hull_rounding * largest);

  const double negligible = hull_negligible * largest;
  const auto has_negligible = [negligible](const Vec3& p) {
    return (p.array() != 0 && p.array().abs() < negligible).any();
  };
  if (std::none_of(points.begin(), points.end(), has_negligible)) return hull_of(points, tolerance);
  std::vector<Vec3> rounded(points.begin(), points.end());
  for (Vec3& p : rounded)
    for (int k = 0; k < 3; ++k)
      if (std::abs(p[k]) < negligible) p[k] = 0;
  auto hull = hull_of(rounded, tolerance);
  if (hull) hull->polyhedron.vertices = pick(points, hull->source);
  return hull;
}

}  // namespace tumble
