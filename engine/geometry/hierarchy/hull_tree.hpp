#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"
#include "engine/geometry/hierarchy/hull_kind.hpp"

namespace tumble {

/// Binary tree of rounded convex hulls of at most 26 points: 44 bytes a node and 4 a point.
using HullTree = BoundingTree<HullKind>;

extern template class BoundingTree<HullKind>;

}  // namespace tumble
