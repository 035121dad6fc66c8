#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// Solid cylinder along y about the origin. Its caps are exact discs in distance queries; contacts
/// on a cap are at points of its rim.
class CylinderShape final : public ConvexShape {
 public:
  static constexpr uint32_t rim_points = 8;  ///< of each cap, for contacts
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  double radius() const { return def().radius; }
  double half_height() const { return half_height_; }
  double bounding_radius() const override;
  double inner_radius() const override { return std::min(radius(), half_height_); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override;
  /// A cap as a polygon of fixed rim points, plus the extreme rim point if the cap is tilted; or
  /// the line on the side.
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override {
    return nearest_on_cylinder(half_height_, radius(), p);
  }
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const override;
  double rounding_along(const Vec3& outward) const override;
  PolyhedronFeature feature_at(const Vec3& point, uint32_t triangle) const override;
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override;

 private:
  explicit CylinderShape(const ShapeDef& def)
      : ConvexShape(def, {}, ShapeSymmetry::axis), half_height_(def.height / 2) {
    view_ = CoreView::of_reach(CylinderShape::bounding_radius());
  }
  double half_height_;
};

}  // namespace tumble
