#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Sine of the angle by which the common normal may leave the wedge of an edge.
constexpr double wedge_slack = 0.1;
/// Edges more nearly parallel than this are left to their ends.
constexpr double parallel = 1e-3;

/// Whether n (unit, own frame, out of the surface) lies between the normals of the edge's faces.
bool in_wedge(const MeshSurface& s, const MeshEdge& edge, const Vec3& n) {
  const Vec3& p = s.vertex(edge.vertices[0]);
  const Vec3 u = (s.vertex(edge.vertices[1]) - p).normalized();
  for (uint32_t f : edge.faces) {
    if (f == no_index) continue;
    // across the edge into the face
    Vec3 into = s.topology.face_normals[f].cross(u);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = s.mesh->triangles[f][k];
      if (v == edge.vertices[0] || v == edge.vertices[1]) continue;
      if (into.dot(s.vertex(v) - p) < 0) into = -into;
    }
    if (n.dot(into) > wedge_slack) return false;
  }
  return true;
}

}  // namespace

std::optional<EdgeContact> edge_contact(const PlacedSurface& A, const PlacedEdge& a,
                                        const PlacedSurface& B, const PlacedEdge& b,
                                        const ContactRange& range) {
  const Vec3 &u = a.along, &w = b.along;
  const Vec3 c = u.cross(w);
  const double c2 = c.squaredNorm();
  if (!(c2 > parallel * parallel * u.squaredNorm() * w.squaredNorm())) return std::nullopt;
  const Vec3 r = b.start - a.start;
  constexpr double slack = 1e-9;
  const double s = r.cross(w).dot(c) / c2;
  if (s < -slack || s > 1 + slack) return std::nullopt;
  const double t = r.cross(u).dot(c) / c2;
  if (t < -slack || t > 1 + slack) return std::nullopt;
  Vec3 n = c / std::sqrt(c2);
  if (n.dot(a.normal) - n.dot(b.normal) < 0) n = -n;
  if (n.dot(a.normal) <= 0 || n.dot(b.normal) >= 0) return std::nullopt;
  const double gap = n.dot(r);
  if (gap > range.margin || gap < -range.reach) return std::nullopt;
  const MeshEdge &ea = A.s.topology.edges[a.id], &eb = B.s.topology.edges[b.id];
  const Vec3 na = A.local_direction(n), nb = B.local_direction(-n);
  if (!in_wedge(A.s, ea, na) || !in_wedge(B.s, eb, nb)) return std::nullopt;
  if (gap < 0) {
    const double thick = A.s.thickness_along(ea.faces, na) + B.s.thickness_along(eb.faces, nb);
    if (-gap > 0.5 * thick) return std::nullopt;
  }
  return EdgeContact{a.start + s * u, b.start + t * w, n, gap};
}

bool triangles_cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const auto pierces = [](const std::array<Vec3, 3>& edges, const std::array<Vec3, 3>& face) {
    const Vec3 n = (face[1] - face[0]).cross(face[2] - face[0]);
    std::array<double, 3> h;
    for (size_t k = 0; k < 3; ++k) h[k] = n.dot(edges[k] - face[0]);
    for (size_t k = 0; k < 3; ++k) {
      const size_t l = (k + 1) % 3;
      if ((h[k] > 0) == (h[l] > 0)) continue;
      const Vec3 x = edges[k] + (h[k] / (h[k] - h[l])) * (edges[l] - edges[k]);
      bool inside = true;
      for (size_t i = 0; i < 3; ++i)
        inside = inside && n.dot((face[(i + 1) % 3] - face[i]).cross(x - face[i])) > 0;
      if (inside) return true;
    }
    return false;
  };
  return pierces(a, b) || pierces(b, a);
}

}  // namespace tumble
