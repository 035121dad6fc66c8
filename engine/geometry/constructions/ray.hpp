#pragma once
#include "engine/math/types.hpp"

#include <cstdint>

namespace tumble {

/// The points origin + t direction with 0 <= t. The direction may have any length; t is measured
/// in it. A zero direction hits nothing, except that solids hit a ray that starts inside.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();

  Vec3 at(double t) const { return origin + t * direction; }
};

/// First hit of a ray with a solid. A ray that starts inside (or on the surface, going in) hits at
/// t = 0 with normal -direction / |direction|.
struct RayHit {
  double t = 0;
  Vec3 normal = Vec3::Zero();  ///< outward unit normal there
  uint32_t feature = 0;        ///< triangle of a mesh, face of a polyhedron, else 0
};

}  // namespace tumble
