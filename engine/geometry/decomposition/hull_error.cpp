#include "engine/geometry/decomposition/hull_error.hpp"

#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace tumble {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Raises `worst` to the distance of p from the mesh if that is larger and p lies outside.
void offer(const Vec3& p, const Hierarchy& surface, double& worst) {
  const auto near = surface.closest(p, no_limit);
  if (!near) return;
  const double d = std::sqrt(near->squared_distance);
  if (d > worst && point_in_object(p, surface).side == PointSide::outside) worst = d;
}

/// Distance of a point from a convex body; 0 inside.
double distance_outside(const ConvexPolyhedron& hull, const Hierarchy& hull_surface,
                        const Vec3& p) {
  double most = -no_limit;
  for (const Plane& plane : hull.planes) most = std::max(most, plane.distance(p));
  if (most <= 0) return 0;
  const auto near = hull_surface.closest(p, no_limit);
  return near ? std::sqrt(near->squared_distance) : most;
}

}  // namespace

double reach_outside(const TriangleMesh& convex, const Hierarchy& surface, size_t samples,
                     double enough) {
  const SurfaceSamples on_surface(convex);
  const InsideSamples inside(convex);
  double worst = 0;
  for (size_t n = 1; n <= samples && worst <= enough && !stop_requested(); ++n) {
    offer(on_surface(n).point, surface, worst);
    offer(inside(n), surface, worst);
  }
  return worst;
}

HullError measure_hulls(const std::vector<ConvexPiece>& pieces, const Hierarchy& surface,
                        size_t samples) {
  HullError out;
  std::vector<std::unique_ptr<AabbTree>> hulls;
  hulls.reserve(pieces.size());
  for (const ConvexPiece& piece : pieces) {
    hulls.push_back(
        std::make_unique<AabbTree>(std::make_shared<const TriangleMesh>(to_mesh(piece.hull))));
    const size_t share = samples / (2 * pieces.size()) + 50;
    out.added = std::max(out.added, reach_outside(hulls.back()->mesh(), surface, share, no_limit));
  }
  const SurfaceSamples on_surface(surface.mesh());
  for (size_t n = 1; n <= samples && !stop_requested(); ++n) {
    const Vec3 p = on_surface(n).point;
    double least = no_limit;
    for (size_t k = 0; k < pieces.size() && least > out.missing; ++k)
      least = std::min(least, distance_outside(pieces[k].hull, *hulls[k], p));
    if (std::isfinite(least)) out.missing = std::max(out.missing, least);
  }
  return out;
}

}  // namespace tumble
