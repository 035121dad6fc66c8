#include "engine/collision/shapes/convex_hull.hpp"

#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/hull/convex_hull.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// Up to this many vertices a scan is faster than climbing along edges.
constexpr size_t scan_limit = 48;

}  // namespace

Result<std::shared_ptr<const Shape>> ConvexHullShape::make(const ShapeDef& def) {
  if (!def.mesh)
    return Error{ErrorCode::invalid_argument, "a convex_hull needs points, got none", {}, {}};
  auto hull = convex_hull(def.mesh->vertices);
  if (!hull) return hull.error();
  return std::shared_ptr<const Shape>(new ConvexHullShape(def, std::move(hull.value().polyhedron)));
}

ConvexHullShape::ConvexHullShape(const ShapeDef& def, ConvexPolyhedron polyhedron)
    : ConvexShape(def), polyhedron_(std::move(polyhedron)) {
  for (const Vec3& v : polyhedron_.vertices) centre_ += v;
  centre_ /= double(polyhedron_.vertices.size());
  for (const Vec3& v : polyhedron_.vertices)
    bounding_radius_ = std::max(bounding_radius_, v.norm());
  inner_radius_ = std::numeric_limits<double>::infinity();
  for (const Plane& p : polyhedron_.planes)
    inner_radius_ = std::min(inner_radius_, -p.distance(centre_));
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    octant_start_[k] = support_vertex(polyhedron_, d);
  }
}

Result<MassProperties> ConvexHullShape::mass_properties() const {
  return polyhedron_mass(polyhedron_);
}

std::optional<RayHit> ConvexHullShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                                double t_max) const {
  return ray_convex({origin, direction}, polyhedron_.planes.data(), polyhedron_.planes.size(),
                    t_max);
}

Vec3 ConvexHullShape::support(const Vec3& d) const {
  if (polyhedron_.vertices.size() <= scan_limit) {
    const Vec3* best = polyhedron_.vertices.data();
    double height = best->dot(d);
    for (const Vec3& v : polyhedron_.vertices) {
      const double h = v.dot(d);
      if (h > height) height = h, best = &v;
    }
    return *best;
  }
  const size_t octant = size_t((d.x() > 0) + 2 * (d.y() > 0) + 4 * (d.z() > 0));
  return polyhedron_.vertices[support_vertex_from(polyhedron_, d, octant_start_[octant])];
}

void ConvexHullShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  size_t best = 0;
  double alignment = -2;
  for (size_t f = 0; f < polyhedron_.planes.size(); ++f) {
    const double a = polyhedron_.planes[f].normal.dot(direction);
    if (a > alignment) alignment = a, best = f;
  }
  const auto loop = polyhedron_.face(best);
  face.count = 0;
  // A facet with very many corners is thinned out evenly.
  const size_t n = std::min(loop.size(), size_t(SupportingFace::capacity));
  for (size_t i = 0; i < n; ++i) {
    const uint32_t v = loop[i * loop.size() / n];
    face.add(polyhedron_.vertices[v], v);
  }
}

MeshSurface ConvexHullShape::make_surface() const {
  return build_mesh_surface(std::make_shared<TriangleMesh>(to_mesh(polyhedron_)));
}

}  // namespace tumble
