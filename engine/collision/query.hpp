#pragma once
#include "engine/collision/shape.hpp"

#include <limits>
#include <optional>

namespace tumble {

// Questions about single shapes at poses, for picking and for queries on a world.

/// First hit of a world ray; t in multiples of the direction's length, normal in world axes.
std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray_world,
                               double t_max);

/// Point of a shape's surface nearest to some point.
struct ClosestPoint {
  Vec3 x_world = Vec3::Zero();  ///< on the surface [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, outward, world axes
  double distance = 0;          ///< negative inside solids [m]
  uint32_t triangle = 0;        ///< of a mesh
};

/// Nothing when the surface is farther than `max_distance` (>= 0) [m]; points inside a solid count
/// as near. For open meshes "inside" is behind the surface.
std::optional<ClosestPoint> closest_point(
    const Shape& shape, const Pose& pose, const Vec3& x_world,
    double max_distance = std::numeric_limits<double>::infinity());

/// Whether a world point is in the solid or on its surface: convex shapes, half-spaces, and closed
/// meshes (a winding number other than zero, exact in the mesh's frame). Open meshes hold nothing.
bool holds_point(const Shape& shape, const Pose& pose, const Vec3& x_world);

/// Whether two shapes touch or overlap. Convex shapes, half-spaces and closed meshes are solid, so
/// that one which holds all of the other counts; of an open mesh only the surface does, from either
/// side. Two half-spaces never do, and neither does a pose that is not finite.
bool overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace tumble
