#pragma once
#include "engine/collision/few_points.hpp"
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/math/types.hpp"

#include <cstdint>

namespace tumble {

/// One point of a contact manifold.
struct ManifoldPoint {
  Vec3 x_world = Vec3::Zero();  ///< midway between the two surfaces [m]
  double gap = 0;               ///< along the normal; negative is penetration [m]
  uint64_t feature = 0;         ///< which features touch; the same pair of features keeps its key
};

/// Data common to the points of a manifold.
struct ManifoldHead {
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, world axes
  /// Distinguishes the manifolds of one pair of shapes (mesh patches).
  uint64_t part = 0;
  /// Of two polyhedra, for the start of the next query, if the narrow phase finds them; of an open
  /// mesh, on which side of it the other mesh is (mesh_pairs/open_side.hpp).
  ClosestFeatures closest;
  int count = 0;  ///< number of points
};

/// Up to four points that share a normal.
struct Manifold : FewPoints<ManifoldHead, ManifoldPoint> {
  Manifold() {}  // not cleared where it is made by resize
};

}  // namespace tumble
