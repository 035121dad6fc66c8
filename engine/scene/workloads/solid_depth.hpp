#pragma once
#include "engine/collision/shape.hpp"

#include <vector>

/// How deep two convex solids overlap, by means as plain as can be: what judges the fast ways must
/// not be one of them.
namespace tumble {

/// A convex solid in the world: all points within `radius` of the hull of `vertices`.
struct MeasuredSolid {
  std::vector<Vec3> vertices;  ///< one of a sphere, two of a capsule
  std::vector<Vec3> normals;   ///< of its faces, unit; opposite ones once
  std::vector<Vec3> edges;     ///< directions of its edges, unit; parallel ones once
  double radius = 0;           ///< [m]
  Aabb bounds;
  Pose pose;                         ///< of a box
  Vec3 half_extents = Vec3::Zero();  ///< of a box, else zero
};

/// Spheres, capsules, boxes and convex hulls.
MeasuredSolid measured_solid(const Shape& shape, const Pose& pose);

/// The least distance by which moving one of them parts the two, or 0 when they are apart [m]:
/// polyhedra by all their separating axes (normals of either, cross products of edges); spheres
/// and capsules by the distance of their cores, from a box by its signed distance. Round against
/// hull is in no workload, and 0.
double solid_depth(const MeasuredSolid& a, const MeasuredSolid& b);

/// Signed distance of a point in a box's own frame from its surface [m].
double box_distance(const Vec3& half_extents, const Vec3& x);

}  // namespace tumble
