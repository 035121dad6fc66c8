#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"
#include "engine/geometry/hierarchy/sphere_kind.hpp"

namespace tumble {

/// Binary tree of minimal spheres: 24 bytes a node.
using SphereTree = BoundingTree<SphereKind>;

extern template class BoundingTree<SphereKind>;

}  // namespace tumble
