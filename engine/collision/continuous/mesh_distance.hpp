#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

#include <memory>

namespace tumble {

/// The distance of a convex shape or mesh (A) and a mesh (B): of the triangles nearest to each
/// other. Surfaces that have no common direction between them: their approach is bounded by the
/// fastest points alone.
std::unique_ptr<MovingDistance> mesh_distance(const MovingPair& pair);

}  // namespace tumble
