#include "engine/collision/shapes/half_space.hpp"

#include "engine/geometry/constructions/ray_casts.hpp"

#include <limits>

namespace tumble {

constexpr double infinity = std::numeric_limits<double>::infinity();

Result<std::shared_ptr<const Shape>> HalfSpaceShape::make(const ShapeDef& def) {
  return std::shared_ptr<const Shape>(new HalfSpaceShape(def));
}

Aabb HalfSpaceShape::bounds(const Pose& pose) const {
  Aabb box{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
  const Vec3 n = pose.direction(Vec3::UnitY());
  for (int k = 0; k < 3; ++k) {
    if (n[(k + 1) % 3] != 0 || n[(k + 2) % 3] != 0) continue;
    (n[k] > 0 ? box.max : box.min)[k] = pose.x[k];
  }
  return box;
}

double HalfSpaceShape::bounding_radius() const {
  return infinity;
}
double HalfSpaceShape::inner_radius() const {
  return infinity;
}

Result<MassProperties> HalfSpaceShape::mass_properties() const {
  return Error{ErrorCode::unsupported,
               "a half-space has no finite volume",
               {},
               "make the body static or give it another shape"};
}

std::optional<RayHit> HalfSpaceShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                               double t_max) const {
  return ray_half_space({origin, direction}, Plane{Vec3::UnitY(), 0}, t_max);
}

SurfaceElement HalfSpaceShape::element_at(const Vec3&, const Vec3&) const {
  return {ElementKind::plane, Vec3::Zero(), Vec3::UnitY(), 0};
}
SurfaceElement HalfSpaceShape::border_at(const Vec3& point, const Vec3&) const {
  return material_point(point);
}

std::string HalfSpaceShape::words() const {
  return "half-space";
}
void HalfSpaceShape::outline(DebugDraw&, const Vec4f&) const {}

extern const ShapeEntry half_space_entry;
constinit const ShapeEntry half_space_entry{
    "half_space", ShapeType::half_space, ShapeFamily::half_space, false, HalfSpaceShape::make, {}};

}  // namespace tumble
