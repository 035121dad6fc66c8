#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Any convex shape (A) with a mesh (B), triangle by triangle; used for curved shapes.
void collide_convex_mesh(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
