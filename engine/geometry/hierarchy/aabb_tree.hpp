#pragma once
#include "engine/geometry/hierarchy/aabb_kind.hpp"
#include "engine/geometry/hierarchy/bounding_tree.hpp"

namespace tumble {

/// Binary tree of axis-aligned boxes, in single precision about the centre of the mesh, rounded
/// outwards: 32 bytes a node.
using AabbTree = BoundingTree<AabbKind>;

/// Appends the pairs (a of A's mesh, b of B's) whose bounding boxes are at most `margin` [m] apart
/// along each axis, both when taken in A's frame and in B's (triangle_boxes_near); ascending. Pairs
/// of triangles nearer than `margin` are never missed; cheaper than AabbTree::pairs.
void box_pairs(const AabbTree& a, const AabbTree& b, const Pose& b_in_a, double margin,
               std::vector<TriangleIds>& out);

/// Box of a node in the mesh's frame [m].
Aabb node_box(const AabbTree& tree, uint32_t node);

extern template class BoundingTree<AabbKind>;

}  // namespace tumble
