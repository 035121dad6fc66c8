#include "engine/collision/shapes/sphere.hpp"

#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

namespace tumble {

SphereShape::SphereShape(const ShapeDef& def) : ConvexShape(def) {
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

}  // namespace tumble
