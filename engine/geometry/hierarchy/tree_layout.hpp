#pragma once
#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {

/// How a tree is split from the top down.
enum class TreeBuilder {
  surface_area,  ///< binned surface-area heuristic (Wald 2007)
  longest_axis,  ///< at the mean of the triangles' centres along the longest axis (the book's)
};

/// A box in single precision that holds what it bounds: rounded outwards.
struct AabbVolume {
  std::array<float, 3> min, max;
};

/// A node of any tree: its bounding volume, with a leaf's triangles or an inner node's second
/// child. The first child of node i is node i + 1.
template <class Volume>
struct TreeNode : Volume {
  uint32_t start;  ///< leaf: first place in the triangle order; inner: number of the second child
  uint32_t count;  ///< triangles of a leaf; 0 for an inner node

  bool is_leaf() const { return count > 0; }
};

/// The division of a mesh's triangles that all kinds of trees share, with boxes about `origin`,
/// flat in depth-first order.
struct TreeLayout {
  static constexpr uint32_t max_leaf_triangles = 4;
  static constexpr int max_depth = 96;

  std::vector<TreeNode<AabbVolume>> nodes;
  std::vector<uint32_t> order;  ///< triangles by leaf; below a node they stand together
  int depth = 0;
};

/// O(n log n): where the chosen rule cannot separate (equal centres) or grows too deep, the median
/// is taken, so that the depth is bounded for any input.
TreeLayout build_tree_layout(const TriangleMesh& mesh, const Vec3& origin, TreeBuilder builder);

/// Box of one triangle about `origin`, rounded outwards.
AabbVolume rounded_box(const TriangleMesh& mesh, uint32_t triangle, const Vec3& origin);

}  // namespace tumble
