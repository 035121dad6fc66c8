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

/// What the points of a manifold share.
struct ManifoldHead {
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, world axes
  uint64_t part = 0;            ///< tells apart the manifolds of one pair of shapes (mesh patches)
  ClosestFeatures closest;  ///< of two polyhedra, where the narrow phase knows them; start there
  int count = 0;            ///< points
};

/// Up to four points that share a normal.
struct Manifold : FewPoints<ManifoldHead, ManifoldPoint> {
  Manifold() {}  // not cleared where it is made by resize
};

}  // namespace tumble
