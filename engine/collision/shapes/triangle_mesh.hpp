#pragma once
#include "engine/collision/shape.hpp"
#include "engine/collision/shapes/polyhedral_shape.hpp"

namespace tumble {

/// A surface of triangles, counter-clockwise seen from outside; closed (a solid that may move) or
/// open (terrain, solid behind its faces).
class TriangleMeshShape : public PolyhedralShape<Shape> {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return bounding_radius_; }
  /// A quarter of the least thickness of the solid, since contacts between meshes find the
  /// direction of separation only up to that depth; zero for open meshes.
  double inner_radius() const override;
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  double least_thickness() const override { return surface().min_thickness; }
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  DrawnSurface drawn_surface() const override;

 protected:
  explicit TriangleMeshShape(const ShapeDef& def);
  /// Whether the definition has a valid mesh for a shape.
  static Status check(const ShapeDef& def);
  MeshSurface make_surface() const override;

 private:
  Aabb box_;                          ///< of the vertices, own frame
  mutable std::once_flag mass_once_;  ///< the check of a mesh takes as long as its tree
  mutable std::optional<Result<MassProperties>> mass_;
  double bounding_radius_ = 0;
};

}  // namespace tumble
