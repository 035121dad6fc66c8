#include "engine/collision/mesh_pairs/convex_mesh.hpp"

namespace tumble {

void collide_convex_mesh(const ShapePair&, std::vector<Manifold>&) {}

}  // namespace tumble
