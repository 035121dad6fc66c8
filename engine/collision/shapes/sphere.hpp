#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// Ball about the origin; its core is the centre.
class SphereShape final : public ConvexShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  double radius() const { return rounding_; }
  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return radius(); }
  double inner_radius() const override { return radius(); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3&) const override { return Vec3::Zero(); }
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override {
    return nearest_on_ball(radius(), p);
  }
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const override;
  bool has_point(const SurfaceElement&) const override { return true; }
  PolyhedronFeature feature_at(const Vec3& point, uint32_t triangle) const override;
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override;

 private:
  explicit SphereShape(const ShapeDef& def);
};

}  // namespace tumble
