#include "engine/collision/shapes/flat_features.hpp"

#include "engine/collision/v_clip/voronoi_polyhedron.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

constexpr double feature_share = 1e-9;  ///< of the size: what is on a feature

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double along = std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0, 1.0);
  return (p - a - along * d).norm();
}

/// The corner or edge of a polygon at `p`, if there is one.
template <class Corners>
std::optional<SurfaceElement> border_element(const Corners& corner, int count, const Vec3& p,
                                             double size) {
  for (int i = 0; i < count; ++i)
    if ((corner(i) - p).norm() <= element_close_by * size) return material_point(corner(i));
  for (int i = 0; i < count; ++i) {
    const Vec3 a = corner(i), b = corner((i + 1) % count);
    if (distance_to_segment(p, a, b) <= element_close_by * size)
      return SurfaceElement{ElementKind::line, a, (b - a).normalized(), 0};
  }
  return {};
}

std::optional<SurfaceElement> convex_border(const ConvexShape& shape, const SupportingFace& face,
                                            const Vec3& p) {
  return border_element([&](int i) { return face.points[size_t(i)]; }, face.count, p,
                        shape.bounding_radius());
}

PolyhedronFeature on_polyhedron(const VoronoiPolyhedron& s, const Vec3& p) {
  const double within = feature_share * s.radius + s.flatness;
  for (uint32_t v = 0; v < s.vertices.size(); ++v) {
    if ((p - s.vertices[v]).squaredNorm() <= within * within) return {FeatureKind::vertex, v};
  }
  // The outermost planes: two for a point on their edge.
  uint32_t best = 0, second = 0;
  double height = -1e300, lower = -1e300;
  for (uint32_t f = 0; f < s.faces.size(); ++f) {
    const double h = s.faces[f].normal.dot(p) - s.faces[f].offset;
    if (h > height) {
      second = best, lower = height;
      best = f, height = h;
    } else if (h > lower) {
      second = f, lower = h;
    }
  }
  if (lower >= -within) {
    for (const VoronoiSide& side : s.sides_of(s.faces[best])) {
      const auto& faces = s.edges[side.edge].faces;
      if (faces[0] == second || faces[1] == second) return {FeatureKind::edge, side.edge};
    }
  }
  return {FeatureKind::face, best};
}

}  // namespace

SurfaceElement flat_element(const ConvexShape& shape, const Vec3& p, const Vec3& n) {
  SupportingFace face;
  shape.supporting_face(n, face);
  const auto border = convex_border(shape, face, p);
  if (face.count < 3) return border.value_or(material_point(p));
  const Vec3 side = face.points[1] - face.points[0];
  const Vec3 normal = side.cross(face.points[2] - face.points[0]).normalized();
  if (border && !element_along(normal, n)) return *border;
  return {ElementKind::plane, face.points[0], normal, 0};
}

SurfaceElement flat_border(const ConvexShape& shape, const Vec3& p, const Vec3& n) {
  SupportingFace face;
  shape.supporting_face(n, face);
  return convex_border(shape, face, p).value_or(material_point(p));
}

namespace {

/// The triangle at `p` and the element there; `flat`: a face across `n` is wanted.
SurfaceElement mesh_element(const MeshSurface& surface, const Vec3& p, const Vec3& n, bool flat) {
  const auto near = surface.tree->closest(p, 1e-3 * surface.size);
  if (!near) return material_point(p);
  const auto& triangle = surface.mesh->triangles[near->triangle];
  const auto corner = [&](int i) { return surface.vertex(triangle[size_t(i)]); };
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  if (flat && element_along(normal, n)) return {ElementKind::plane, corner(0), normal, 0};
  if (const auto border = border_element(corner, 3, p, surface.size)) return *border;
  return flat ? SurfaceElement{ElementKind::plane, corner(0), normal, 0} : material_point(p);
}

}  // namespace

SurfaceElement flat_element(const MeshSurface& surface, const Vec3& p, const Vec3& n) {
  return mesh_element(surface, p, n, true);
}

SurfaceElement flat_border(const MeshSurface& surface, const Vec3& p, const Vec3& n) {
  return mesh_element(surface, p, n, false);
}

bool has_vertex(const MeshSurface& surface, const Vec3& p) {
  for (uint32_t v = 0; v < surface.mesh->vertices.size(); ++v)
    if ((surface.vertex(v) - p).norm() <= element_close_by * surface.size) return true;
  return false;
}

PolyhedronFeature flat_feature(const ConvexShape& shape, const Vec3& p, uint32_t) {
  const VoronoiPolyhedron* polyhedron = shape.voronoi();
  if (!polyhedron) return {FeatureKind::face, 0};
  return on_polyhedron(*polyhedron, p);
}

PolyhedronFeature flat_feature(const MeshSurface& s, const Vec3& p, uint32_t t) {
  const TrianglePoint on =
      closest_on_triangle(p, s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2));
  const double within = feature_share * s.size;
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t v = s.mesh->triangles[t][k];
    if ((on.point - s.vertex(v)).norm() <= within) return {FeatureKind::vertex, v};
  }
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t e = s.topology.face_edges[t][k];
    if (e == no_index) continue;
    const Vec3 a = s.vertex(s.topology.edges[e].vertices[0]);
    const Vec3 along = s.vertex(s.topology.edges[e].vertices[1]) - a;
    if (along.cross(on.point - a).norm() <= within * along.norm()) return {FeatureKind::edge, e};
  }
  return {FeatureKind::face, t};
}

}  // namespace tumble
