#pragma once
#include "engine/collision/shape.hpp"

namespace tumble {

/// All points with y <= 0 of its own frame.
class HalfSpaceShape final : public Shape {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  /// Infinite, except on one side if the normal is along a world axis.
  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override;
  double inner_radius() const override;
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  SurfaceElement element_at(const Vec3& point, const Vec3& outward) const override;
  SurfaceElement border_at(const Vec3& point, const Vec3& outward) const override;
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override { return {ShapeDrawing::Kind::plane, Vec3::Ones()}; }

 private:
  explicit HalfSpaceShape(const ShapeDef& def)
      : Shape(def, ShapeFamily::half_space, ShapeSymmetry::none) {}
};

}  // namespace tumble
