#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// All points within a radius of a segment along y; the segment is the core.
class CapsuleShape final : public ConvexShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  double radius() const { return rounding_; }
  /// Half the distance between the two centres [m].
  double half_height() const { return half_height_; }
  double bounding_radius() const override { return half_height_ + radius(); }
  double inner_radius() const override { return radius(); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override {
    return {0, d.y() < 0 ? -half_height_ : half_height_, 0};
  }
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override {
    return nearest_on_capsule(half_height_, radius(), p);
  }
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const override;
  bool has_point(const SurfaceElement& element) const override;
  PolyhedronFeature feature_at(const Vec3& point, uint32_t triangle) const override;
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override;

 private:
  explicit CapsuleShape(const ShapeDef& def);
  double half_height_;
};

}  // namespace tumble
