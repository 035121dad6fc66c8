#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// A convex shape (A) with a distance field (B).
void collide_convex_field(const ShapePair& pair, std::vector<Manifold>& out);
/// A triangle mesh (A) with a distance field (B).
void collide_mesh_field(const ShapePair& pair, std::vector<Manifold>& out);
/// Two distance fields.
void collide_field_field(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
