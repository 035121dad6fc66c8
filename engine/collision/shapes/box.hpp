#pragma once
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/lazy_voronoi.hpp"
#include "engine/collision/shapes/polyhedral_shape.hpp"

namespace tumble {

/// Box about the origin. Vertex k has the signs of the bits of k: x (1), y (2), z (4).
class BoxShape final : public PolyhedralShape<ConvexShape> {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  const Vec3& half_extents() const { return def().half_extents; }
  Vec3 vertex(unsigned k) const {
    const Vec3& h = half_extents();
    return {k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z()};
  }
  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return view().reach; }
  double inner_radius() const override { return half_extents().minCoeff(); }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& d) const override {
    const Vec3& h = half_extents();
    return {d.x() < 0 ? -h.x() : h.x(), d.y() < 0 ? -h.y() : h.y(), d.z() < 0 ? -h.z() : h.z()};
  }
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::optional<SurfacePoint> nearest(const Vec3& p) const override {
    return nearest_on_box(half_extents(), p);
  }
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  ShapeDrawing drawing() const override;
  const VoronoiPolyhedron* voronoi() const override;

 protected:
  MeshSurface make_surface() const override;

 private:
  explicit BoxShape(const ShapeDef& def)
      : PolyhedralShape(def, CoreView::of_box(def.half_extents)) {}
  LazyVoronoi voronoi_;
};

}  // namespace tumble
