#pragma once
#include "engine/collision/shape.hpp"

#include <limits>
#include <optional>

namespace tumble {

// Queries on single shapes at poses, for picking and for queries on a world.

/// First hit of a world ray; t is in multiples of the direction's length, the normal in world axes.
std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray_world,
                               double t_max);

/// The point of a shape's surface nearest to a query point.
struct ClosestPoint {
  Vec3 x_world = Vec3::Zero();  ///< on the surface [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, outward, world axes
  double distance = 0;          ///< negative inside solids [m]
  uint32_t triangle = 0;        ///< of a mesh
};

/// Empty when the surface is farther than `max_distance` (>= 0) [m]; points inside a solid always
/// have a result. For open meshes "inside" is behind the surface.
std::optional<ClosestPoint> closest_point(
    const Shape& shape, const Pose& pose, const Vec3& x_world,
    double max_distance = std::numeric_limits<double>::infinity());

/// Whether a world point is inside a solid or on its surface: convex shapes, half-spaces, and
/// closed meshes (nonzero winding number, exact in the mesh's frame). Open meshes contain no point.
bool holds_point(const Shape& shape, const Pose& pose, const Vec3& x_world);

/// Whether two shapes touch or overlap. Convex shapes, half-spaces and closed meshes are solid, so
/// that one that contains all of the other counts; of an open mesh only the surface counts, from
/// either side. False for two half-spaces, and for a pose that is not finite.
bool overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

}  // namespace tumble
