#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <memory>
#include <optional>
#include <span>

namespace tumble {

/// The boundary of the union of a body's convex shapes: all parts of their surfaces that lie in no
/// other shape. The distance from an inner point to the outside of the union is that to the nearest
/// point of this surface, however the union is divided into shapes.
///
/// From every face the parts covered by other shapes are cut off, shape by shape (a convex polygon
/// minus a convex solid is at most as many convex polygons as the solid has planes). Slits narrower
/// than `inner_slit` of the body's size count as closed; faces that lie flush with each other
/// remain. Flat faces are exact. Round surfaces are represented by tangent planes at a net of
/// meridians and parallels: distances are exact at their points of contact, and elsewhere at most 2
/// % of the radius too large.
/// 2 % of the radius at most.
class BareSurface {
 public:
  explicit BareSurface(std::span<const BodyShape> shapes);

  /// The nearest point of the surface, if it is not empty.
  std::optional<Vec3> nearest(const Vec3& p) const;
  /// Where the ray p + t d meets the surface first: t, in lengths of d.
  std::optional<double> ray(const Vec3& p, const Vec3& d) const;
  /// All shapes lie within this of the origin [m].
  double size() const { return size_; }
  size_t triangles() const { return tree_->mesh().triangles.size(); }

 private:
  std::unique_ptr<Hierarchy> tree_;
  double size_ = 0;
};

}  // namespace tumble
