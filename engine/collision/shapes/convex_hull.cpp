#include "engine/collision/shapes/convex_hull.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/hull/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The normals coordinate by coordinate, the last one repeated so that whole blocks can be scanned.
std::vector<double> normals_of(const ConvexPolyhedron& p) {
  const size_t count = p.face_count();
  const size_t padded = (count + scan_block - 1) / scan_block * scan_block;
  std::vector<double> normals;
  normals.reserve(3 * padded);
  for (int k = 0; k < 3; ++k)
    for (size_t i = 0; i < padded; ++i)
      normals.push_back(p.planes[std::min(i, count - 1)].normal[k]);
  return normals;
}

VertexCloudView as_cloud(const std::vector<double>& normals) {
  const size_t padded = normals.size() / 3;
  const double* x = normals.data();
  return {x, x + padded, x + 2 * padded, uint32_t(padded), nullptr};
}

/// The least and the greatest height of a vertex along d.
std::array<double, 2> extent(const VertexCloudView& v, const Plain3& d) {
  if (v.table) return {v[v.table->furthest(-d)].dot(d), v[v.table->furthest(d)].dot(d)};
  const __m128d x = _mm_set1_pd(d.x), y = _mm_set1_pd(d.y), z = _mm_set1_pd(d.z);
  __m128d least = FourHeights::two(v, 0, x, y, z), most = least;
  for (uint32_t i = 2; i < v.padded; i += 2) {
    const __m128d h = FourHeights::two(v, i, x, y, z);
    least = _mm_min_pd(least, h);
    most = _mm_max_pd(most, h);
  }
  least = _mm_min_pd(least, _mm_shuffle_pd(least, least, 1));
  most = _mm_max_pd(most, _mm_shuffle_pd(most, most, 1));
  return {_mm_cvtsd_f64(least), _mm_cvtsd_f64(most)};
}

}  // namespace

Result<std::shared_ptr<const Shape>> ConvexHullShape::make(const ShapeDef& def) {
  if (!def.mesh)
    return Error{ErrorCode::invalid_argument, "a convex_hull needs points, got none", {}, {}};
  auto hull = convex_hull(def.mesh->vertices);
  if (!hull) return hull.error();
  return std::shared_ptr<const Shape>(new ConvexHullShape(def, std::move(hull.value().polyhedron)));
}

ConvexHullShape::ConvexHullShape(const ShapeDef& def, ConvexPolyhedron polyhedron)
    : PolyhedralShape(def),
      polyhedron_(std::move(polyhedron)),
      cloud_(polyhedron_.vertices),
      normals_(normals_of(polyhedron_)) {
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

Aabb ConvexHullShape::bounds(const Pose& pose) const {
  const Mat3 R = pose.q.toRotationMatrix();
  Aabb box;
  for (int k = 0; k < 3; ++k) {
    const auto [least, most] = extent(view().vertices, Plain3::of(R.row(k).transpose()));
    box.min[k] = pose.x[k] + least;
    box.max[k] = pose.x[k] + most;
  }
  return box;
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
  return polyhedron_.vertices[furthest_vertex(view().vertices, Plain3::of(d))];
}

void ConvexHullShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  const size_t best = scan_many_vertices(as_cloud(normals_), Plain3::of(direction));
  const auto loop = polyhedron_.face(std::min(best, polyhedron_.face_count() - 1));
  face.count = 0;
  // A facet with very many corners is thinned out evenly.
  const size_t n = std::min(loop.size(), size_t(SupportingFace::capacity));
  for (size_t i = 0; i < n; ++i) {
    const uint32_t v = n == loop.size() ? loop[i] : loop[i * loop.size() / n];
    face.add(polyhedron_.vertices[v], v);
  }
}

const VoronoiPolyhedron* ConvexHullShape::voronoi() const {
  return voronoi_.get([&]() -> Result<ConvexPolyhedron> { return polyhedron_; });
}

MeshSurface ConvexHullShape::make_surface() const {
  return build_mesh_surface(std::make_shared<TriangleMesh>(to_mesh(polyhedron_)));
}

std::string ConvexHullShape::words() const {
  return fmt::format("convex hull of {} points", def().mesh->vertices.size());
}

void ConvexHullShape::outline(DebugDraw& out, const Vec4f& colour) const {
  for (const PolyhedronEdge& e : polyhedron_.edges)
    out.line(polyhedron_.vertices[e.vertices[0]], polyhedron_.vertices[e.vertices[1]], colour);
}

DrawnSurface ConvexHullShape::drawn_surface() const {
  return drawn_mesh(to_mesh(polyhedron_));
}

extern const ShapeEntry convex_hull_entry;
constinit const ShapeEntry convex_hull_entry{
    "convex_hull", ShapeType::convex_hull, ShapeFamily::convex, true, ConvexHullShape::make, {}};

}  // namespace tumble
