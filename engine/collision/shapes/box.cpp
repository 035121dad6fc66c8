#include "engine/collision/shapes/box.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>

#include <fmt/format.h>

namespace tumble {

Result<std::shared_ptr<const Shape>> BoxShape::make(const ShapeDef& def) {
  for (int k = 0; k < 3; ++k) {
    const std::string name = std::string("half_extents.") + "xyz"[k];
    if (auto s = require_positive(name, def.half_extents[k]); !s) return s.error();
  }
  return std::shared_ptr<const Shape>(new BoxShape(def));
}

Aabb BoxShape::bounds(const Pose& pose) const {
  const Vec3 reach = pose.q.toRotationMatrix().cwiseAbs() * half_extents();
  return {pose.x - reach, pose.x + reach};
}

Result<MassProperties> BoxShape::mass_properties() const {
  return box_mass(half_extents());
}

std::optional<RayHit> BoxShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                         double t_max) const {
  auto hit = ray_box({origin, direction}, half_extents(), t_max);
  if (!hit) return hit;
  int axis = 0;
  hit->normal.cwiseAbs().maxCoeff(&axis);
  hit->feature = uint32_t(2 * axis + (hit->normal[axis] > 0));
  return hit;
}

void BoxShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const bool positive = direction[axis] > 0;
  const unsigned fixed = positive ? 1u << axis : 0u;
  unsigned u = 1u << ((axis + 1) % 3), v = 1u << ((axis + 2) % 3);
  if (!positive) std::swap(u, v);  // counter-clockwise seen from outside
  face.count = 0;
  for (unsigned k : {fixed, fixed | u, fixed | u | v, fixed | v}) face.add(vertex(k), k);
}

const VoronoiPolyhedron* BoxShape::voronoi() const {
  return voronoi_.get([&] {
    std::vector<Vec3> vertices;
    for (unsigned k = 0; k < 8; ++k) vertices.push_back(vertex(k));
    std::vector<std::vector<uint32_t>> loops;
    SupportingFace face;
    for (int axis = 0; axis < 3; ++axis)
      for (double sign : {-1.0, 1.0}) {
        supporting_face(sign * Vec3::Unit(axis), face);
        loops.emplace_back(face.ids.begin(), face.ids.begin() + face.count);
      }
    return make_polyhedron(std::move(vertices), std::move(loops));
  });
}

MeshSurface BoxShape::make_surface() const {
  auto mesh = std::make_shared<TriangleMesh>();
  for (unsigned k = 0; k < 8; ++k) mesh->vertices.push_back(vertex(k));
  SupportingFace face;
  for (int axis = 0; axis < 3; ++axis)
    for (double sign : {-1.0, 1.0}) {
      supporting_face(sign * Vec3::Unit(axis), face);
      mesh->triangles.push_back({face.ids[0], face.ids[1], face.ids[2]});
      mesh->triangles.push_back({face.ids[0], face.ids[2], face.ids[3]});
    }
  return build_mesh_surface(std::move(mesh));
}

std::string BoxShape::words() const {
  const Vec3 size = 2 * half_extents();
  return fmt::format("box, {:.3g} × {:.3g} × {:.3g} m", size.x(), size.y(), size.z());
}

void BoxShape::outline(DebugDraw& out, const Vec4f& colour) const {
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 4; ++i) {
      Vec3 a = half_extents();
      a[(axis + 1) % 3] *= i & 1 ? 1 : -1;
      a[(axis + 2) % 3] *= i & 2 ? 1 : -1;
      Vec3 b = a;
      b[axis] = -b[axis];
      out.line(a, b, colour);
    }
}

ShapeDrawing BoxShape::drawing() const {
  return {ShapeDrawing::Kind::box, half_extents()};
}

namespace {
constexpr std::array box_parameters{
    ShapeParameter{.parameter = length_parameter("size", "full extents along x, y, z"),
                   .vector = &ShapeDef::half_extents,
                   .factor = 0.5}};
}
extern const ShapeEntry box_entry;
constinit const ShapeEntry box_entry{"box", ShapeType::box, ShapeFamily::convex,
                                     true,  BoxShape::make, box_parameters};

}  // namespace tumble
