#include "engine/collision/shapes/capsule.hpp"

#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

namespace tumble {

CapsuleShape::CapsuleShape(const ShapeDef& def) : ConvexShape(def), half_height_(def.height / 2) {
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

}  // namespace tumble
