#pragma once
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// Radius of the sphere with the same Gaussian curvature as an ellipsoid where its normal is `n`
/// (unit, in its frame): the geometric mean of the two principal radii, a b c / |D n|^2 [m].
double mean_radius_of_curvature(const Vec3& semi_axes, const Vec3& n);

/// Solid ellipsoid about the origin, its semi-axes along x, y, z. Smooth: it touches in one point,
/// and its support function sqrt(n^T D^2 n), with D the diagonal matrix of the semi-axes, is exact.
class EllipsoidShape final : public ConvexShape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  const Vec3& semi_axes() const { return def().half_extents; }
  double bounding_radius() const override { return semi_axes().maxCoeff(); }
  double inner_radius() const override { return semi_axes().minCoeff(); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override;
  /// The support point.
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override;
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const override;
  SurfaceElement border_at(const Vec3& point, const Vec3& outward) const override;
  double rounding_along(const Vec3& outward) const override {
    return mean_radius_of_curvature(semi_axes(), outward);
  }
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override;

 private:
  explicit EllipsoidShape(const ShapeDef& def)
      : ConvexShape(def, CoreView::of_reach(def.half_extents.maxCoeff())) {}
};

}  // namespace tumble
