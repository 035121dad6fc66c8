#include "engine/collision/shapes/convex_hull.hpp"

#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/hull/convex_hull.hpp"

#include <algorithm>
#include <limits>

namespace tumble {

Result<std::shared_ptr<const Shape>> ConvexHullShape::make(const ShapeDef& def) {
  if (!def.mesh)
    return Error{ErrorCode::invalid_argument, "a convex_hull needs points, got none", {}, {}};
  auto hull = convex_hull(def.mesh->vertices);
  if (!hull) return hull.error();
  return std::shared_ptr<const Shape>(new ConvexHullShape(def, std::move(hull.value().polyhedron)));
}

ConvexHullShape::ConvexHullShape(const ShapeDef& def, ConvexPolyhedron polyhedron)
    : ConvexShape(def), polyhedron_(std::move(polyhedron)), cloud_(polyhedron_.vertices) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& v : polyhedron_.vertices) centre += v;
  centre /= double(polyhedron_.vertices.size());
  for (const Vec3& v : polyhedron_.vertices)
    bounding_radius_ = std::max(bounding_radius_, v.norm());
  view_ = CoreView::of_vertices(cloud_.view(), bounding_radius_, centre);
  inner_radius_ = std::numeric_limits<double>::infinity();
  for (const Plane& p : polyhedron_.planes)
    inner_radius_ = std::min(inner_radius_, -p.distance(centre));
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
  return polyhedron_.vertices[cloud_.furthest(d)];
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

const VoronoiPolyhedron* ConvexHullShape::voronoi() const {
  return voronoi_.get([&]() -> Result<ConvexPolyhedron> { return polyhedron_; });
}

MeshSurface ConvexHullShape::make_surface() const {
  return build_mesh_surface(std::make_shared<TriangleMesh>(to_mesh(polyhedron_)));
}

}  // namespace tumble
