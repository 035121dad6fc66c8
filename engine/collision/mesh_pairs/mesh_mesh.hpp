#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Two triangulated surfaces (meshes, boxes, hulls): see mesh_pairs/README.md.
void collide_mesh_mesh(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
