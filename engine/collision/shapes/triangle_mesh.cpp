#include "engine/collision/shapes/triangle_mesh.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/validation.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {

Status TriangleMeshShape::check(const ShapeDef& def) {
  if (!def.mesh)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("a {} needs a mesh, got none", shape_entry(def.type).name),
                 {},
                 {}};
  MeshLimits limits;
  limits.max_coordinate = max_shape_size;
  return validate(*def.mesh, limits);
}

Result<std::shared_ptr<const Shape>> TriangleMeshShape::make(const ShapeDef& def) {
  if (Status s = check(def); !s) return s.error();
  std::shared_ptr<TriangleMeshShape> shape(new TriangleMeshShape(def));
  // Here, where loading is expected to take time; only open meshes are met from behind.
  if (!shape->surface().closed) shape->reversed();
  return std::shared_ptr<const Shape>(shape);
}

TriangleMeshShape::TriangleMeshShape(const ShapeDef& def)
    : PolyhedralShape(def, ShapeFamily::mesh, ShapeSymmetry::none),
      box_(tumble::bounds(*def.mesh)) {
  for (const Vec3& v : def.mesh->vertices) bounding_radius_ = std::max(bounding_radius_, v.norm());
}

Aabb TriangleMeshShape::bounds(const Pose& pose) const {
  const Vec3 centre = pose.point(box_.centre());
  const Vec3 reach = pose.q.toRotationMatrix().cwiseAbs() * (0.5 * box_.extent());
  return {centre - reach, centre + reach};
}

double TriangleMeshShape::inner_radius() const {
  return surface().closed ? 0.25 * surface().min_thickness : 0;
}

Result<MassProperties> TriangleMeshShape::mass_properties() const {
  std::call_once(mass_once_, [this] { mass_.emplace(mesh_mass(*def().mesh)); });
  return *mass_;
}

std::optional<RayHit> TriangleMeshShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                                  double t_max) const {
  const auto hit = surface().tree->ray({origin, direction}, t_max);
  if (!hit) return std::nullopt;
  return RayHit{hit->t, surface().topology.face_normals[hit->triangle], hit->triangle};
}

MeshSurface TriangleMeshShape::make_surface() const {
  return build_mesh_surface(def().mesh);
}

std::string TriangleMeshShape::words() const {
  return fmt::format("mesh, {} triangles", def().mesh->triangles.size());
}

void TriangleMeshShape::outline(DebugDraw& out, const Vec4f& colour) const {
  draw_edges(out, colour, *def().mesh);
}

DrawnSurface TriangleMeshShape::drawn_surface() const {
  return drawn_mesh(*def().mesh);
}

extern const ShapeEntry triangle_mesh_entry;
constinit const ShapeEntry triangle_mesh_entry{"triangle_mesh",         ShapeType::triangle_mesh,
                                               ShapeFamily::mesh,       true,
                                               TriangleMeshShape::make, {}};

}  // namespace tumble
