#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <memory>
#include <optional>
#include <span>

namespace tumble {

/// What is bare of the surfaces of a body's convex shapes: all that lies in none of the others. So
/// the distance from a point inside to the outside of the union is that to the nearest bare point,
/// however the union is cut into shapes.
///
/// Of every face what other shapes cover is cut off, one shape after the other (a convex polygon
/// without a convex solid is at most as many convex polygons as the solid has planes). Slits that
/// are narrower than `inner_slit` of the body's size count as closed, and faces that lie flush with
/// each other stay bare. Flat faces are exact; round surfaces are planes that touch them on a net
/// of meridians and parallels, so that distances in their middle are exact and others too large by
/// 2 % of the radius at most.
class BareSurface {
 public:
  explicit BareSurface(std::span<const BodyShape> shapes);

  /// The nearest bare point, if there is any.
  std::optional<Vec3> nearest(const Vec3& p) const;
  /// Where a ray comes to a bare point [lengths of d].
  std::optional<double> ray(const Vec3& p, const Vec3& d) const;
  /// All shapes lie within this of the origin [m].
  double size() const { return size_; }
  size_t triangles() const { return tree_->mesh().triangles.size(); }

 private:
  std::unique_ptr<Hierarchy> tree_;
  double size_ = 0;
};

}  // namespace tumble
