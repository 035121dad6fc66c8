#include "engine/collision/shapes/sphere.hpp"

#include "engine/collision/shapes/outlines.hpp"
#include "engine/collision/shapes/parameters.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>

#include <fmt/format.h>

namespace tumble {

SphereShape::SphereShape(const ShapeDef& def) : ConvexShape(def, {}, ShapeSymmetry::point) {
  rounding_ = def.radius;
  view_ = CoreView::of_box(Vec3::Zero());
}

Result<std::shared_ptr<const Shape>> SphereShape::make(const ShapeDef& def) {
  if (auto s = require_positive("radius", def.radius); !s) return s.error();
  return std::shared_ptr<const Shape>(new SphereShape(def));
}

Aabb SphereShape::bounds(const Pose& pose) const {
  return Aabb{pose.x, pose.x}.inflated(radius());
}

Result<MassProperties> SphereShape::mass_properties() const {
  return sphere_mass(radius());
}

std::optional<RayHit> SphereShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                            double t_max) const {
  return ray_sphere({origin, direction}, Vec3::Zero(), radius(), t_max);
}

void SphereShape::supporting_face(const Vec3&, SupportingFace& face) const {
  face.count = 0;
  face.add(Vec3::Zero(), 0);
}

SurfaceElement SphereShape::element_at(const Vec3&, const Vec3&) const {
  return {ElementKind::point, Vec3::Zero(), Vec3::UnitY(), radius()};
}

/// Vertex 0, the centre.
PolyhedronFeature SphereShape::feature_at(const Vec3&, uint32_t) const {
  return {FeatureKind::vertex, 0};
}

std::string SphereShape::words() const {
  return fmt::format("sphere, radius {:.4g} m", radius());
}

void SphereShape::outline(DebugDraw& out, const Vec4f& colour) const {
  draw_round_outline(out, colour, radius(), 0, true);
}

ShapeDrawing SphereShape::drawing() const {
  return {ShapeDrawing::Kind::ball, Vec3::Constant(radius())};
}

namespace {
constexpr std::array sphere_parameters{
    ShapeParameter{length_parameter("radius", "radius"), &ShapeDef::radius}};
}
extern const ShapeEntry sphere_entry;
constinit const ShapeEntry sphere_entry{"sphere", ShapeType::sphere, ShapeFamily::convex,
                                        false,    SphereShape::make, sphere_parameters};

}  // namespace tumble
