#pragma once
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/lazy_voronoi.hpp"
#include "engine/collision/shapes/polyhedral_shape.hpp"
#include "engine/geometry/hull/convex_polyhedron.hpp"

namespace tumble {

/// Convex hull of the vertices of `ShapeDef::mesh`, with merged facets.
class ConvexHullShape final : public PolyhedralShape<ConvexShape> {
 public:
  static Result<std::shared_ptr<const Shape>> make(const ShapeDef& def);

  const ConvexPolyhedron& polyhedron() const { return polyhedron_; }
  Aabb bounds(const Pose& pose) const override;
  double bounding_radius() const override { return bounding_radius_; }
  double inner_radius() const override { return inner_radius_; }
  Result<MassProperties> mass_properties() const override;
  std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                 double t_max) const override;
  Vec3 support(const Vec3& direction) const override;
  void supporting_face(const Vec3& direction, SupportingFace& face) const override;
  std::span<const Vec3> corners() const override { return polyhedron_.vertices; }
  std::string words() const override;
  void outline(DebugDraw& out, const Vec4f& colour) const override;
  DrawnSurface drawn_surface() const override;
  const VoronoiPolyhedron* voronoi() const override;

 protected:
  MeshSurface make_surface() const override;

 private:
  ConvexHullShape(const ShapeDef& def, ConvexPolyhedron polyhedron);
  ConvexPolyhedron polyhedron_;
  VertexCloud cloud_;
  std::vector<double> normals_;  ///< of the faces: all x, all y, all z
  LazyVoronoi voronoi_;
  double bounding_radius_ = 0, inner_radius_ = 0;
};

}  // namespace tumble
