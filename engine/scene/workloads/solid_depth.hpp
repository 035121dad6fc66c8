#pragma once
#include "engine/collision/shape.hpp"

#include <vector>

/// Penetration depth of two convex solids by the simplest possible methods, as a reference for the
/// engine's fast ones.
namespace tumble {

/// A convex solid in the world: all points within `radius` of the hull of `vertices`.
struct MeasuredSolid {
  std::vector<Vec3> vertices;  ///< one of a sphere, two of a capsule
  std::vector<Vec3> normals;   ///< unit normals of its faces, one of each opposite pair
  std::vector<Vec3> edges;     ///< unit directions of its edges, one of each parallel pair
  double radius = 0;           ///< [m]
  Aabb bounds;
  Pose pose;                         ///< of a box
  Vec3 half_extents = Vec3::Zero();  ///< of a box, else zero
};

/// Spheres, capsules, boxes and convex hulls.
MeasuredSolid measured_solid(const Shape& shape, const Pose& pose);

/// The least distance by which one solid must be moved to separate the two, or 0 if they are
/// disjoint [m]. For polyhedra over all separating axes (normals of either, cross products of
/// edges); for spheres and capsules by the distance of their cores, or the signed distance from a
/// box. Round against hull does not occur in any workload, and gives 0.
double solid_depth(const MeasuredSolid& a, const MeasuredSolid& b);

/// Signed distance of a point, given in the box's own frame, from the surface of the box [m].
double box_distance(const Vec3& half_extents, const Vec3& x);

}  // namespace tumble
