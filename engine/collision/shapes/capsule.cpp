#include "engine/collision/shapes/capsule.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

CapsuleShape::CapsuleShape(const ShapeDef& def)
    : ConvexShape(def, {}, ShapeSymmetry::axis), half_height_(def.height / 2) {
  rounding_ = def.radius;
  view_ = CoreView::of_box({0, half_height_, 0});
}

Result<std::shared_ptr<const Shape>> CapsuleShape::make(const ShapeDef& def) {
  if (auto s = require_positive("radius", def.radius); !s) return s.error();
  if (auto s = require_not_negative("height", def.height); !s) return s.error();
  return std::shared_ptr<const Shape>(new CapsuleShape(def));
}

Result<MassProperties> CapsuleShape::mass_properties() const {
  return capsule_mass(half_height_, radius());
}

std::optional<RayHit> CapsuleShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                             double t_max) const {
  return ray_capsule({origin, direction}, half_height_, radius(), t_max);
}

void CapsuleShape::supporting_face(const Vec3&, SupportingFace& face) const {
  face.count = 0;
  face.add({0, -half_height_, 0}, 0);
  if (half_height_ > 0) face.add({0, half_height_, 0}, 1);
}

SurfaceElement CapsuleShape::element_at(const Vec3& p, const Vec3& n) const {
  const double half = half_height_, r = radius();
  const double along_axis = p.y() - r * n.y();
  if (std::fabs(along_axis) >= half - element_close_by * (half + r))
    return {ElementKind::point, {0, along_axis < 0 ? -half : half, 0}, Vec3::UnitY(), r};
  return {ElementKind::line, Vec3::Zero(), Vec3::UnitY(), r};
}

bool CapsuleShape::has_point(const SurfaceElement& element) const {
  return std::fabs(element.origin.y()) >= half_height_ * (1 - element_close_by);
}

/// Vertex 0 below and 1 above, or edge 0 between them.
PolyhedronFeature CapsuleShape::feature_at(const Vec3& p, uint32_t) const {
  constexpr double on_feature = 1e-9;
  const double end = half_height_ - on_feature * (radius() + def().height);
  if (std::fabs(p.y()) < end) return {FeatureKind::edge, 0};
  return {FeatureKind::vertex, p.y() > 0 ? 1u : 0u};
}

std::string CapsuleShape::words() const {
  return fmt::format("capsule, {:.4g} × {:.4g} m", radius(), def().height);
}

void CapsuleShape::outline(DebugDraw& out, const Vec4f& colour) const {
  draw_round_outline(out, colour, radius(), half_height_, true);
}

ShapeDrawing CapsuleShape::drawing() const {
  return {ShapeDrawing::Kind::capsule, {radius(), half_height_, radius()}};
}

namespace {
constexpr std::array capsule_parameters{
    ShapeParameter{length_parameter("radius", "radius"), &ShapeDef::radius},
    ShapeParameter{length_parameter("height", "between the centres of the two caps, along y"),
                   &ShapeDef::height}};
}
extern const ShapeEntry capsule_entry;
constinit const ShapeEntry capsule_entry{"capsule", ShapeType::capsule, ShapeFamily::convex,
                                         false,     CapsuleShape::make, capsule_parameters};

}  // namespace tumble
