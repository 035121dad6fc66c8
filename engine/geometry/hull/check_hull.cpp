#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/hull/plane_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

Error fault(std::string message) {
  return Error{ErrorCode::internal, std::move(message), {}, {}};
}

/// Checks that all indices are in range.
Status check_indices(const ConvexPolyhedron& hull) {
  const size_t sides = hull.face_vertices.size(), faces = hull.face_count();
  const auto below = [](const std::vector<uint32_t>& list, size_t limit) {
    return std::all_of(list.begin(), list.end(), [&](uint32_t i) { return i < limit; });
  };
  if (hull.face_first.size() != faces + 1 || hull.face_first.front() != 0 ||
      hull.face_first.back() != sides ||
      !std::is_sorted(hull.face_first.begin(), hull.face_first.end())) {
    return fault(fmt::format("face_first does not cut {} half-edges into {} faces", sides, faces));
  }
  if (hull.half_edge_twin.size() != sides || hull.half_edge_face.size() != sides ||
      !below(hull.half_edge_twin, sides) || !below(hull.face_vertices, hull.vertices.size())) {
    return fault("a half-edge has no twin, face or vertex");
  }
  if (hull.neighbour_first.size() != hull.vertices.size() + 1 ||
      hull.neighbour_first.back() != hull.neighbours.size() ||
      !std::is_sorted(hull.neighbour_first.begin(), hull.neighbour_first.end()) ||
      !below(hull.neighbours, hull.vertices.size())) {
    return fault("the lists of neighbours are damaged");
  }
  for (size_t f = 0; f < faces; ++f) {
    if (hull.face(f).size() < 3) return fault(fmt::format("face {} has under three corners", f));
    for (uint32_t h = hull.face_first[f]; h < hull.face_first[f + 1]; ++h) {
      if (hull.half_edge_face[h] != f) return fault(fmt::format("half-edge {} is not {}'s", h, f));
    }
  }
  return {};
}

/// Whether every vertex and face can be reached from the first one along half-edges.
bool is_connected(const ConvexPolyhedron& hull) {
  std::vector<uint8_t> seen(hull.face_count(), 0);
  std::vector<uint32_t> stack{0};
  seen[0] = 1;
  size_t count = 1;
  while (!stack.empty()) {
    const uint32_t f = stack.back();
    stack.pop_back();
    for (uint32_t h = hull.face_first[f]; h < hull.face_first[f + 1]; ++h) {
      const uint32_t g = hull.half_edge_face[hull.half_edge_twin[h]];
      if (seen[g]) continue;
      seen[g] = 1;
      ++count;
      stack.push_back(g);
    }
  }
  return count == seen.size();
}

Status check_topology(const ConvexPolyhedron& hull) {
  if (hull.vertices.size() + hull.face_count() != hull.edges.size() + 2) {
    return fault(fmt::format("Euler's formula fails: {} vertices - {} edges + {} faces is not 2",
                             hull.vertices.size(), hull.edges.size(), hull.face_count()));
  }
  if (2 * hull.edges.size() != hull.face_vertices.size()) {
    return fault(
        fmt::format("{} edges have {} half-edges", hull.edges.size(), hull.face_vertices.size()));
  }
  std::vector<uint8_t> used(hull.vertices.size(), 0);
  for (uint32_t h = 0; h < hull.face_vertices.size(); ++h) {
    const uint32_t twin = hull.half_edge_twin[h];
    if (hull.half_edge_twin[twin] != h || hull.half_edge_face[twin] == hull.half_edge_face[h] ||
        hull.face_vertices[twin] != hull.face_vertices[hull.next(h)] ||
        hull.face_vertices[h] != hull.face_vertices[hull.next(twin)]) {
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
  if (!is_connected(hull)) return fault("the faces fall into separate parts");
  return {};
}

/// Checks that loops turn left at every corner, seen from outside.
Status check_face(const ConvexPolyhedron& hull, size_t f, double epsilon) {
  const auto loop = hull.face(f);
  const Plane& plane = hull.planes[f];
  if (!(std::fabs(plane.normal.norm() - 1) <= 1e-12)) {
    return fault(fmt::format("the normal of face {} is not a unit vector", f));
  }
  for (size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = hull.vertices[loop[k]];
    const Vec3& b = hull.vertices[loop[(k + 1) % loop.size()]];
    if (!(std::fabs(plane.distance(a)) <= epsilon)) {
      return fault(fmt::format("vertex {} is {:.3g} m off the plane of its face {}", loop[k],
                               plane.distance(a), f));
    }
    if (a == b) return fault(fmt::format("side {} of face {} has no length", k, f));
  }
  if (!is_convex_loop(hull.vertices, loop, plane.normal, epsilon)) {
    return fault(fmt::format("face {} is not convex", f));
  }
  return {};
}

}  // namespace

Status check_hull(const ConvexPolyhedron& hull, std::span<const Vec3> points, double epsilon) {
  if (hull.face_count() < 4) return fault(fmt::format("{} faces only", hull.face_count()));
  if (const Status ok = check_indices(hull); !ok) return ok;
  if (const Status ok = check_topology(hull); !ok) return ok;
  for (size_t f = 0; f < hull.face_count(); ++f) {
    if (const Status ok = check_face(hull, f, epsilon); !ok) return ok;
  }
  std::vector<Vec3> touched;
  for (size_t f = 0; f < hull.face_count(); ++f) {
    touched.push_back(hull.vertices[hull.face(f)[0]]);
  }
  const PlaneTree planes(hull.planes, std::move(touched));
  const auto inside = [&](const char* what, std::span<const Vec3> all) -> Status {
    for (size_t i = 0; i < all.size(); ++i) {
      if (!all[i].allFinite()) return fault(fmt::format("{} {} is not finite", what, i));
      const uint32_t f = planes.first_outside(all[i], epsilon);
      if (f == no_index) continue;
      return fault(fmt::format("{} {} is {:.3g} m outside face {}", what, i,
                               hull.planes[f].distance(all[i]), f));
    }
    return {};
  };
  if (const Status ok = inside("vertex", hull.vertices); !ok) return ok;
  return inside("point", points);
}

}  // namespace tumble
