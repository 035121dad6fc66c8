#include "engine/geometry/hull/convex_hull.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

Error fault(std::string message) {
  return Error{ErrorCode::internal, std::move(message), {}, {}};
}

Status check_topology(const ConvexPolyhedron& hull) {
  if (hull.vertices.size() + hull.face_count() != hull.edges.size() + 2) {
    return fault(fmt::format("Euler's formula fails: {} vertices - {} edges + {} faces is not 2",
                             hull.vertices.size(), hull.edges.size(), hull.face_count()));
  }
  std::vector<uint8_t> used(hull.vertices.size(), 0);
  for (uint32_t h = 0; h < hull.face_vertices.size(); ++h) {
    const uint32_t twin = hull.half_edge_twin[h];
    if (hull.half_edge_twin[twin] != h || hull.half_edge_face[twin] == hull.half_edge_face[h] ||
        hull.face_vertices[twin] != hull.face_vertices[hull.next(h)]) {
      return fault(fmt::format("half-edge {} and its twin {} do not match", h, twin));
    }
    used[hull.face_vertices[h]] = 1;
  }
  for (size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) return fault(fmt::format("vertex {} belongs to no face", v));
    if (hull.neighbours_of(uint32_t(v)).size() < 3) {
      return fault(fmt::format("vertex {} has fewer than three neighbours", v));
    }
  }
  return {};
}

/// Loops turn left at every corner, seen from outside.
Status check_face(const ConvexPolyhedron& hull, size_t f, double epsilon) {
  const auto loop = hull.face(f);
  const Plane& plane = hull.planes[f];
  if (std::fabs(plane.normal.norm() - 1) > 1e-12) {
    return fault(fmt::format("the normal of face {} is not a unit vector", f));
  }
  for (size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = hull.vertices[loop[k]];
    const Vec3& b = hull.vertices[loop[(k + 1) % loop.size()]];
    if (std::fabs(plane.distance(a)) > epsilon) {
      return fault(fmt::format("vertex {} is {:.3g} m off the plane of its face {}", loop[k],
                               plane.distance(a), f));
    }
    const Vec3 inward = plane.normal.cross(b - a).normalized();
    for (uint32_t v : loop) {
      if (inward.dot(hull.vertices[v] - a) < -epsilon) {
        return fault(fmt::format("face {} is not convex at side {}", f, k));
      }
    }
  }
  return {};
}

}  // namespace

Status check_hull(const ConvexPolyhedron& hull, std::span<const Vec3> points, double epsilon) {
  if (const Status ok = check_topology(hull); !ok) return ok;
  for (size_t f = 0; f < hull.face_count(); ++f) {
    if (const Status ok = check_face(hull, f, epsilon); !ok) return ok;
    const auto outside = [&](const Vec3& p) { return hull.planes[f].distance(p) > epsilon; };
    for (size_t v = 0; v < hull.vertices.size(); ++v) {
      if (outside(hull.vertices[v])) {
        return fault(fmt::format("vertex {} is {:.3g} m outside face {}", v,
                                 hull.planes[f].distance(hull.vertices[v]), f));
      }
    }
    for (size_t i = 0; i < points.size(); ++i) {
      if (outside(points[i])) {
        return fault(fmt::format("point {} is {:.3g} m outside face {}", i,
                                 hull.planes[f].distance(points[i]), f));
      }
    }
  }
  return {};
}

}  // namespace tumble
