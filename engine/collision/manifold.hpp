#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

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

/// Up to four points that share a normal. Many have one only: beyond `count` none is initialised or
/// copied.
struct Manifold : ManifoldHead {
  union {
    std::array<ManifoldPoint, 4> points;
  };

  Manifold() {}
  Manifold(const Manifold& from) : ManifoldHead(from) { take_points(from); }
  Manifold& operator=(const Manifold& from) {
    ManifoldHead::operator=(from);
    take_points(from);
    return *this;
  }

 private:
  void take_points(const Manifold& from) {
    std::uninitialized_copy_n(from.points.begin(), size_t(count), points.begin());
  }
};

}  // namespace tumble
