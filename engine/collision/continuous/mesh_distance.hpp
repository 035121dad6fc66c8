#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

#include <memory>

namespace tumble {

/// Distance of a convex shape or mesh (A) and a mesh (B): that of their nearest triangles. Surfaces
/// have no separating direction as a whole, so their approach is bounded by the speeds of the
/// fastest points alone.
std::unique_ptr<MovingDistance> mesh_distance(const MovingPair& pair);

}  // namespace tumble
