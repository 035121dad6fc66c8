#include "engine/collision/mesh_pairs/mesh_mesh.hpp"

namespace tumble {

void collide_mesh_mesh(const ShapePair&, std::vector<Manifold>&) {}

}  // namespace tumble
