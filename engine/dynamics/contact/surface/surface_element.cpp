#include "engine/dynamics/contact/surface/surface_element.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

constexpr double parallel = 1e-6;  ///< [rad]
constexpr double close_by = 1e-6;  ///< of the size

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
    if ((corner(i) - p).norm() <= close_by * size) return material_point(corner(i));
  for (int i = 0; i < count; ++i) {
    const Vec3 a = corner(i), b = corner((i + 1) % count);
    if (distance_to_segment(p, a, b) <= close_by * size)
      return SurfaceElement{ElementKind::line, a, (b - a).normalized(), 0};
  }
  return {};
}

bool along(const Vec3& a, const Vec3& b) {
  return a.dot(b) > 0 && a.cross(b).norm() <= parallel;
}

std::optional<SurfaceElement> convex_border(const ConvexShape& shape, const SupportingFace& face,
                                            const Vec3& p) {
  return border_element([&](int i) { return face.points[size_t(i)]; }, face.count, p,
                        shape.bounding_radius());
}

SurfaceElement convex_element(const ConvexShape& shape, const Vec3& p, const Vec3& n) {
  SupportingFace face;
  shape.supporting_face(n, face);
  const auto border = convex_border(shape, face, p);
  if (face.count < 3) return border.value_or(material_point(p));
  const Vec3 side = face.points[1] - face.points[0];
  const Vec3 normal = side.cross(face.points[2] - face.points[0]).normalized();
  if (border && !along(normal, n)) return *border;
  return {ElementKind::plane, face.points[0], normal, 0};
}

SurfaceElement capsule_element(const Shape& shape, const Vec3& p, const Vec3& n) {
  const double half = 0.5 * shape.def().height, r = shape.def().radius;
  const double along_axis = p.y() - r * n.y();
  if (std::fabs(along_axis) >= half - close_by * (half + r))
    return {ElementKind::point, {0, along_axis < 0 ? -half : half, 0}, Vec3::UnitY(), r};
  return {ElementKind::line, Vec3::Zero(), Vec3::UnitY(), r};
}

SurfaceElement cylinder_element(const Shape& shape, const Vec3& p, const Vec3& n) {
  const double half = 0.5 * shape.def().height, r = shape.def().radius;
  const double side = p.y() < 0 ? -1 : 1;
  if (along(n, side * Vec3::UnitY()))
    return {ElementKind::plane, {0, side * half, 0}, side * Vec3::UnitY(), 0};
  if (std::fabs(p.y()) < half * (1 - close_by))
    return {ElementKind::line, Vec3::Zero(), Vec3::UnitY(), r};
  if (p.x() * p.x() + p.z() * p.z() < r * r * (1 - close_by))
    return {ElementKind::plane, {0, side * half, 0}, side * Vec3::UnitY(), 0};
  // Only the point of the rim that is furthest out travels along it.
  const Vec3 furthest = r * Vec3(n.x(), 0, n.z()).normalized() + side * half * Vec3::UnitY();
  // Of a rim that lies nearly flat it is anywhere, but not lower.
  const double size = shape.bounding_radius();
  if ((furthest - p).norm() > close_by * size && n.dot(furthest - p) > 1e-12 * size)
    return material_point(p);
  return {ElementKind::circle, {0, side * half, 0}, Vec3::UnitY(), r};
}

/// `flat`: a face across `n` is wanted.
SurfaceElement mesh_element(const MeshSurface& surface, const Vec3& p, const Vec3& n, bool flat) {
  const auto near = surface.tree->closest(p, 1e-3 * surface.size);
  if (!near) return material_point(p);
  const auto& triangle = surface.mesh->triangles[near->triangle];
  const auto corner = [&](int i) { return surface.vertex(triangle[size_t(i)]); };
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  if (flat && along(normal, n)) return {ElementKind::plane, corner(0), normal, 0};
  if (const auto border = border_element(corner, 3, p, surface.size)) return *border;
  return flat ? SurfaceElement{ElementKind::plane, corner(0), normal, 0} : material_point(p);
}

SurfaceElement ellipsoid_element(const Shape& shape) {
  SurfaceElement e{ElementKind::ellipsoid};
  e.semi_axes = shape.def().half_extents.asDiagonal();
  return e;
}

SurfaceElement shape_element(const Shape& shape, const Vec3& p, const Vec3& n) {
  switch (shape.type()) {
    case ShapeType::sphere:
      return {ElementKind::point, Vec3::Zero(), Vec3::UnitY(), shape.def().radius};
    case ShapeType::capsule:
      return capsule_element(shape, p, n);
    case ShapeType::cylinder:
      return cylinder_element(shape, p, n);
    case ShapeType::ellipsoid:
      return ellipsoid_element(shape);
    case ShapeType::half_space:
      return {ElementKind::plane, Vec3::Zero(), Vec3::UnitY(), 0};
    case ShapeType::triangle_mesh:
      return mesh_element(shape.polyhedral()->surface(), p, n, true);
    default:
      return convex_element(*shape.convex(), p, n);
  }
}

}  // namespace

SurfaceElement material_point(const Vec3& point) {
  return {ElementKind::point, point, Vec3::UnitY(), 0};
}

namespace {

SurfaceElement in_body(const BodyShape& shape, SurfaceElement e) {
  e.origin = shape.pose.point(e.origin);
  e.direction = shape.pose.direction(e.direction);
  if (e.kind == ElementKind::ellipsoid) e.semi_axes = shape.pose.q.toRotationMatrix() * e.semi_axes;
  return e;
}

}  // namespace

SurfaceElement element_at(const BodyShape& shape, const Vec3& point, const Vec3& outward) {
  return in_body(shape, shape_element(*shape.shape, shape.pose.inverse_point(point),
                                      shape.pose.inverse_direction(outward)));
}

SurfaceElement border_at(const BodyShape& shape, const Vec3& point, const Vec3& outward) {
  const Shape& s = *shape.shape;
  const Vec3 p = shape.pose.inverse_point(point), n = shape.pose.inverse_direction(outward);
  switch (s.type()) {
    case ShapeType::box:
    case ShapeType::convex_hull: {
      SupportingFace face;
      s.convex()->supporting_face(n, face);
      return in_body(shape, convex_border(*s.convex(), face, p).value_or(material_point(p)));
    }
    case ShapeType::triangle_mesh:
      return in_body(shape, mesh_element(s.polyhedral()->surface(), p, n, false));
    case ShapeType::ellipsoid:
      return in_body(shape, ellipsoid_element(s));
    default: {
      const double r = s.convex() ? s.convex()->rounding() : 0;
      return in_body(shape, {ElementKind::point, p - r * n, Vec3::UnitY(), r});
    }
  }
}

bool is_feature(const BodyShape& shape, const SurfaceElement& element) {
  if (element.kind != ElementKind::point) return true;
  if (shape.shape->type() == ShapeType::sphere) return true;
  if (shape.shape->type() == ShapeType::capsule) {
    const double half = 0.5 * shape.shape->def().height;
    return std::fabs(shape.pose.inverse_point(element.origin).y()) >= half * (1 - close_by);
  }
  const Polyhedral* polyhedral = shape.shape->polyhedral();
  if (!polyhedral) return false;
  const MeshSurface& surface = polyhedral->surface();
  const Vec3 p = shape.pose.inverse_point(element.origin);
  for (uint32_t v = 0; v < surface.mesh->vertices.size(); ++v)
    if ((surface.vertex(v) - p).norm() <= close_by * surface.size) return true;
  return false;
}

}  // namespace tumble
