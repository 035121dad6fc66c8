#include "engine/collision/continuous/contact_feature.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/v_clip/voronoi_polyhedron.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <cmath>

namespace tumble {
namespace {

constexpr double on_feature = 1e-9;

PolyhedronFeature on_polyhedron(const VoronoiPolyhedron& s, const Vec3& p) {
  const double within = on_feature * s.radius + s.flatness;
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

PolyhedronFeature on_mesh(const MeshSurface& s, const Vec3& p, uint32_t t) {
  const TrianglePoint on =
      closest_on_triangle(p, s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2));
  const double within = on_feature * s.size;
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

PolyhedronFeature on_cylinder(const ShapeDef& def, const Vec3& p) {
  const double within = on_feature * (def.radius + def.height);
  const uint32_t above = p.y() > 0 ? 1 : 0;
  const bool on_cap = std::fabs(p.y()) >= 0.5 * def.height - within;
  const bool around = std::hypot(p.x(), p.z()) >= def.radius - within;
  if (on_cap && around) return {FeatureKind::edge, above};
  return {FeatureKind::face, on_cap ? above : 2};
}

}  // namespace

PolyhedronFeature contact_feature(const Shape& shape, const Vec3& p, uint32_t triangle) {
  const ShapeDef& def = shape.def();
  switch (def.type) {
    case ShapeType::triangle_mesh:
      return on_mesh(shape.polyhedral()->surface(), p, triangle);
    case ShapeType::cylinder:
      return on_cylinder(def, p);
    case ShapeType::capsule: {
      const double end = 0.5 * def.height - on_feature * (def.radius + def.height);
      if (std::fabs(p.y()) < end) return {FeatureKind::edge, 0};
      return {FeatureKind::vertex, p.y() > 0 ? 1u : 0u};
    }
    case ShapeType::half_space:
      return {FeatureKind::face, 0};
    case ShapeType::ellipsoid:
      return {FeatureKind::face, 0};
    case ShapeType::sphere:
      return {FeatureKind::vertex, 0};
    case ShapeType::box:
    case ShapeType::convex_hull:
      break;
  }
  const VoronoiPolyhedron* polyhedron = shape.convex()->voronoi();
  if (!polyhedron) return {FeatureKind::face, 0};
  return on_polyhedron(*polyhedron, p);
}

}  // namespace tumble
