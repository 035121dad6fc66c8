#include "engine/geometry/decomposition/notches.hpp"

#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

uint32_t opposite(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][(s % 3 + 2) % 3];
}

}  // namespace

std::vector<Notch> find_notches(const SolidPiece& piece, std::span<const Plane> planes,
                                double tolerance) {
  std::vector<Notch> out;
  const TriangleMesh& mesh = piece.mesh;
  const double flat = tolerance / bounds(mesh).extent().norm();
  const std::vector<TriangleSide>& mates = piece.mates;
  for (TriangleSide s = 0; s < mates.size(); ++s) {
    const TriangleSide m = mates[s];
    if (m == no_index || m < s) continue;
    const uint32_t plane = piece.plane[s / 3], other = piece.plane[m / 3];
    if (plane == other) continue;
    const uint32_t a = side_start(mesh, s), b = side_end(mesh, s);
    const Vec3 along = mesh.vertices[b] - mesh.vertices[a];
    const double length = along.norm();
    if (length <= tolerance) continue;
    const Vec3 &n = planes[plane].normal, &k = planes[other].normal;
    const double sine = n.cross(k).dot(along) / length;
    // Two faces back to back enclose nearly nothing or nearly everything: their corners tell.
    const bool back_to_back = n.dot(k) < 0 && std::fabs(sine) <= flat;
    const bool reflex = back_to_back ? orientation(mesh.vertices[a], mesh.vertices[b],
                                                   mesh.vertices[opposite(mesh, s)],
                                                   mesh.vertices[opposite(mesh, m)]) > 0
                                     : sine < -flat;
    if (reflex) out.push_back({{a, b}, {plane, other}});
  }
  return out;
}

FlatFaces find_faces(const TriangleMesh& mesh, std::span<const TriangleSide> mates,
                     double tolerance) {
  FlatFaces out;
  const size_t count = mesh.triangles.size();
  out.of_triangle.assign(count, no_index);
  std::vector<double> area(count);
  for (size_t t = 0; t < count; ++t) area[t] = face_area_vector(mesh, t).norm();
  std::vector<uint32_t> by_area(count);
  std::iota(by_area.begin(), by_area.end(), 0u);
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](uint32_t a, uint32_t b) { return area[a] > area[b]; });
  std::vector<uint32_t> stack;
  for (const uint32_t seed : by_area) {
    if (out.of_triangle[seed] != no_index) continue;
    const auto number = uint32_t(out.planes.size());
    const Vec3 normal = face_normal(mesh, seed);
    const Plane plane{normal, normal.dot(mesh.corner(seed, 0))};
    out.planes.push_back(plane);
    out.of_triangle[seed] = number;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const uint32_t t = stack.back();
      stack.pop_back();
      for (size_t k = 0; k < 3; ++k) {
        const TriangleSide m = mates[3 * t + k];
        if (m == no_index || out.of_triangle[m / 3] != no_index) continue;
        if (std::fabs(plane.distance(mesh.vertices[opposite(mesh, m)])) > tolerance ||
            face_area_vector(mesh, m / 3).dot(normal) < 0)
          continue;
        out.of_triangle[m / 3] = number;
        stack.push_back(m / 3);
      }
    }
  }
  return out;
}

}  // namespace tumble
