#include "engine/collision/shapes/ellipsoid.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>

#include <fmt/format.h>

namespace tumble {

Result<std::shared_ptr<const Shape>> EllipsoidShape::make(const ShapeDef& def) {
  for (int k = 0; k < 3; ++k) {
    const std::string name = std::string("half_extents.") + "xyz"[k];
    if (auto s = require_positive(name, def.half_extents[k]); !s) return s.error();
  }
  return std::shared_ptr<const Shape>(new EllipsoidShape(def));
}

Result<MassProperties> EllipsoidShape::mass_properties() const {
  return ellipsoid_mass(semi_axes());
}

std::optional<RayHit> EllipsoidShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                               double t_max) const {
  // Stretched to the unit ball, where t stays what it is.
  const Vec3& a = semi_axes();
  const Ray ray{origin.cwiseQuotient(a), direction.cwiseQuotient(a)};
  auto hit = ray_sphere(ray, Vec3::Zero(), 1, t_max);
  if (!hit) return hit;
  if (hit->t > 0)
    hit->normal = hit->normal.cwiseQuotient(a).normalized();
  else
    hit->normal = direction.isZero(0) ? hit->normal : Vec3(-direction.normalized());
  return hit;
}

Vec3 EllipsoidShape::support(const Vec3& d) const {
  const Vec3& a = semi_axes();
  const double size = d.cwiseAbs().maxCoeff();
  if (!(size > 0)) return {0, a.y(), 0};
  const Vec3 n = a.cwiseProduct(d / size);
  return a.cwiseProduct(n) / n.norm();
}

void EllipsoidShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  face.count = 0;
  face.add(support(direction), 0);
}

std::optional<SurfacePoint> EllipsoidShape::nearest(const Vec3& p) const {
  return nearest_on_ellipsoid(semi_axes(), p);
}

SurfaceElement EllipsoidShape::element_at(const Vec3&, const Vec3&) const {
  SurfaceElement e{ElementKind::ellipsoid};
  e.semi_axes = semi_axes().asDiagonal();
  return e;
}

SurfaceElement EllipsoidShape::border_at(const Vec3& point, const Vec3& outward) const {
  return element_at(point, outward);
}

std::string EllipsoidShape::words() const {
  const Vec3 size = 2 * semi_axes();
  return fmt::format("ellipsoid, {:.3g} × {:.3g} × {:.3g} m", size.x(), size.y(), size.z());
}

void EllipsoidShape::outline(DebugDraw& out, const Vec4f& colour) const {
  for (int k = 0; k < 3; ++k)
    draw_ring(out, colour, Vec3::Zero(), semi_axes()[k] * Vec3::Unit(k),
              semi_axes()[(k + 1) % 3] * Vec3::Unit((k + 1) % 3));
}

ShapeDrawing EllipsoidShape::drawing() const {
  return {ShapeDrawing::Kind::ball, semi_axes()};
}

namespace {
constexpr std::array ellipsoid_parameters{ShapeParameter{
    .parameter = length_parameter("semi_axes", "from the centre to the surface along x, y, z"),
    .vector = &ShapeDef::half_extents}};
}
extern const ShapeEntry ellipsoid_entry;
constinit const ShapeEntry ellipsoid_entry{"ellipsoid", ShapeType::ellipsoid, ShapeFamily::convex,
                                           false,       EllipsoidShape::make, ellipsoid_parameters};

double mean_radius_of_curvature(const Vec3& semi_axes, const Vec3& n) {
  return semi_axes.prod() / semi_axes.cwiseProduct(n).squaredNorm();
}

}  // namespace tumble
