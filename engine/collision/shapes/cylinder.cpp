#include "engine/collision/shapes/cylinder.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double half_root = 0.70710678118654752440;
/// Directions of the rim points, counter-clockwise about +y seen from above (x, z).
constexpr std::array<std::array<double, 2>, CylinderShape::rim_points> rim{
    {{1, 0},
     {half_root, -half_root},
     {0, -1},
     {-half_root, -half_root},
     {-1, 0},
     {-half_root, half_root},
     {0, 1},
     {half_root, half_root}}};
/// Id of the rim point that follows the tilt; the fixed ones are 0 .. 7 (top) and 8 .. 15.
constexpr uint32_t tilt_id = 16;

}  // namespace

Result<std::shared_ptr<const Shape>> CylinderShape::make(const ShapeDef& def) {
  if (auto s = require_positive("radius", def.radius); !s) return s.error();
  if (auto s = require_positive("height", def.height); !s) return s.error();
  return std::shared_ptr<const Shape>(new CylinderShape(def));
}

double CylinderShape::bounding_radius() const {
  return std::sqrt(radius() * radius() + half_height_ * half_height_);
}

Result<MassProperties> CylinderShape::mass_properties() const {
  return cylinder_mass(half_height_, radius());
}

std::optional<RayHit> CylinderShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                              double t_max) const {
  return ray_cylinder({origin, direction}, half_height_, radius(), t_max);
}

Vec3 CylinderShape::support(const Vec3& d) const {
  const double y = d.y() < 0 ? -half_height_ : half_height_;
  const double lateral = std::sqrt(d.x() * d.x() + d.z() * d.z());
  if (lateral == 0) return {0, y, 0};
  const double f = radius() / lateral;
  return {f * d.x(), y, f * d.z()};
}

void CylinderShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  const double lateral = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  face.count = 0;
  if (lateral > std::abs(direction.y())) {
    const double x = radius() * direction.x() / lateral, z = radius() * direction.z() / lateral;
    face.add({x, -half_height_, z}, tilt_id + 1);
    face.add({x, half_height_, z}, tilt_id + 2);
    return;
  }
  const bool top = direction.y() > 0;
  const double y = top ? half_height_ : -half_height_;
  // The rim point that a tilt puts furthest out keeps one id all the way round, so that a coin
  // rolling on its rim keeps its contact. A level cap rests on the fixed points alone.
  const bool tilted = lateral > 1e-4;
  const double ex = tilted ? direction.x() / lateral : 0, ez = tilted ? direction.z() / lateral : 0;
  for (uint32_t i = 0; i < rim_points; ++i) {
    const uint32_t k = top ? i : rim_points - 1 - i;
    const uint32_t next = top ? (k + 1) % rim_points : (k + rim_points - 1) % rim_points;
    face.add({radius() * rim[k][0], y, radius() * rim[k][1]}, k + (top ? 0 : rim_points));
    if (!tilted) continue;
    // between this rim point and the next, by the signs of two cross products about the axis
    const double from = rim[k][1] * ex - rim[k][0] * ez;
    const double to = ez * rim[next][0] - ex * rim[next][1];
    const double toward = rim[k][0] * ex + rim[k][1] * ez;
    if (toward > 0 && (top ? from > 1e-6 && to > 1e-6 : from < -1e-6 && to < -1e-6))
      face.add({radius() * ex, y, radius() * ez}, tilt_id);
  }
}

SurfaceElement CylinderShape::element_at(const Vec3& p, const Vec3& n) const {
  const double half = half_height_, r = radius();
  const double side = p.y() < 0 ? -1 : 1;
  if (element_along(n, side * Vec3::UnitY()))
    return {ElementKind::plane, {0, side * half, 0}, side * Vec3::UnitY(), 0};
  if (std::fabs(p.y()) < half * (1 - element_close_by))
    return {ElementKind::line, Vec3::Zero(), Vec3::UnitY(), r};
  if (p.x() * p.x() + p.z() * p.z() < r * r * (1 - element_close_by))
    return {ElementKind::plane, {0, side * half, 0}, side * Vec3::UnitY(), 0};
  // Only the point of the rim that is furthest out travels along it.
  const Vec3 furthest = r * Vec3(n.x(), 0, n.z()).normalized() + side * half * Vec3::UnitY();
  // Of a rim that lies nearly flat it is anywhere, but not lower.
  const double size = bounding_radius();
  if ((furthest - p).norm() > element_close_by * size && n.dot(furthest - p) > 1e-12 * size)
    return material_point(p);
  return {ElementKind::circle, {0, side * half, 0}, Vec3::UnitY(), r};
}

double CylinderShape::rounding_along(const Vec3& n) const {
  return std::abs(n.y()) < 0.05 ? radius() : 0;
}

/// Face 0 below, 1 above, 2 around; edges 0 and 1, the rims below and above.
PolyhedronFeature CylinderShape::feature_at(const Vec3& p, uint32_t) const {
  constexpr double on_feature = 1e-9;
  const double within = on_feature * (radius() + def().height);
  const uint32_t above = p.y() > 0 ? 1 : 0;
  const bool on_cap = std::fabs(p.y()) >= half_height_ - within;
  const bool around = std::hypot(p.x(), p.z()) >= radius() - within;
  if (on_cap && around) return {FeatureKind::edge, above};
  return {FeatureKind::face, on_cap ? above : 2};
}

std::string CylinderShape::words() const {
  return fmt::format("cylinder, {:.4g} × {:.4g} m", radius(), def().height);
}

void CylinderShape::outline(DebugDraw& out, const Vec4f& colour) const {
  draw_round_outline(out, colour, radius(), half_height_, false);
}

ShapeDrawing CylinderShape::drawing() const {
  return {ShapeDrawing::Kind::cylinder, {radius(), half_height_, radius()}};
}

namespace {
constexpr std::array cylinder_parameters{
    ShapeParameter{length_parameter("radius", "radius"), &ShapeDef::radius},
    ShapeParameter{length_parameter("height", "full height along y"), &ShapeDef::height}};
}
extern const ShapeEntry cylinder_entry;
constinit const ShapeEntry cylinder_entry{"cylinder", ShapeType::cylinder, ShapeFamily::convex,
                                          false,      CylinderShape::make, cylinder_parameters};

}  // namespace tumble
