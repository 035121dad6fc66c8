#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <vector>

namespace tumble {

/// Boxes of triangles that change and vanish, in a tree whose division stays: a leaf's box, and
/// with it those above, follow what its triangles do. Useful while triangles stay about where they
/// were.
class ChangingTree {
 public:
  explicit ChangingTree(const TriangleMesh& mesh);

  void set(uint32_t triangle, const Aabb& box);
  void remove(uint32_t triangle) { set(triangle, {}); }
  /// Calls f(triangle) for those whose box has a point in common with `box`.
  template <class F>
  void each(const Aabb& box, const F& f) const {
    uint32_t stack[64];
    int size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& n = nodes_[stack[--size]];
      if (!n.box.overlaps(box)) continue;
      if (n.left != no_index) {
        stack[size++] = n.left + 1;
        stack[size++] = n.left;
        continue;
      }
      for (uint32_t k = n.first; k < n.first + n.count; ++k)
        if (boxes_[k].overlaps(box)) f(order_[k]);
    }
  }

 private:
  struct Node {
    Aabb box;
    uint32_t first = 0, count = 0;  ///< of a leaf, in order_
    uint32_t left = no_index;       ///< the children are this and the next; no_index: a leaf
    uint32_t parent = no_index;
  };

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;  ///< triangles by leaves
  std::vector<Aabb> boxes_;      ///< in that order
  std::vector<uint32_t> place_;  ///< of each triangle there
  std::vector<uint32_t> leaf_;   ///< of each place
};

}  // namespace tumble
