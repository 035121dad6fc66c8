#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"
#include "engine/geometry/hierarchy/obb_kind.hpp"

namespace tumble {

/// Binary tree of boxes with axes of their own (Gottschalk, Lin & Manocha 1996): 68 bytes a node.
using ObbTree = BoundingTree<ObbKind>;

extern template class BoundingTree<ObbKind>;

}  // namespace tumble
