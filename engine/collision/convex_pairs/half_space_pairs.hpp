#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Half-space (A) with any convex shape: the corners of the shape that are within the margin.
void collide_half_space_convex(const ShapePair& pair, std::vector<Manifold>& out);
/// Half-space (A) with a mesh: the lowest vertices, found through the tree.
void collide_half_space_mesh(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
