#include "engine/geometry/hierarchy/wide_tree.hpp"

#include <limits>

namespace tumble {
namespace {

using BinaryNode = TreeNode<AabbVolume>;

float half_area(const BinaryNode& n) {
  const float x = n.max[0] - n.min[0], y = n.max[1] - n.min[1], z = n.max[2] - n.min[2];
  return x * y + y * z + z * x;
}

/// Up to four nodes that together cover a subtree.
struct Family {
  std::array<uint32_t, 4> nodes;
  size_t size = 0;

  Family(const std::vector<BinaryNode>& all, uint32_t parent) {
    nodes[size++] = parent;
    while (size < 4) {
      size_t widest = size;
      for (size_t k = 0; k < size; ++k) {
        if (all[nodes[k]].is_leaf()) continue;
        if (widest == size || half_area(all[nodes[k]]) > half_area(all[nodes[widest]])) widest = k;
      }
      if (widest == size) break;
      const uint32_t opened = nodes[widest];
      nodes[widest] = opened + 1;
      nodes[size++] = all[opened].start;
    }
  }
};

}  // namespace

WideTree::WideTree(const std::vector<BinaryNode>& nodes, const TriangleMesh& mesh,
                   const std::vector<uint32_t>& order) {
  triangles_.reserve(order.size() + 8);  // so that prefetching stays within the allocation
  for (const uint32_t t : order) triangles_.push_back(mesh.triangles[t]);
  struct Task {
    uint32_t binary, parent, slot;
  };
  constexpr float infinity = std::numeric_limits<float>::infinity();
  nodes_.reserve(nodes.size() / 4 + 1);
  std::vector<Task> tasks;
  if (!nodes.empty()) tasks.push_back({0, no_index, 0});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const auto index = uint32_t(nodes_.size());
    if (task.parent != no_index) nodes_[task.parent].child[task.slot] = index;
    Node node;
    const Family family(nodes, task.binary);
    for (size_t k = 0; k < 4; ++k) {
      const bool there = k < family.size;
      const BinaryNode* child = there ? &nodes[family.nodes[k]] : nullptr;
      for (size_t axis = 0; axis < 3; ++axis) {
        node.bounds[axis][k] = there ? child->min[axis] : infinity;
        node.bounds[axis + 3][k] = there ? child->max[axis] : -infinity;
      }
      node.child[k] = there && child->is_leaf() ? leaf_child(child->start, child->count) : leaf_bit;
    }
    nodes_.push_back(node);
    for (size_t k = family.size; k-- > 0;) {
      if (!nodes[family.nodes[k]].is_leaf()) tasks.push_back({family.nodes[k], index, uint32_t(k)});
    }
  }
}

const WideTree& LazyWideTree::make(const std::vector<BinaryNode>& nodes, const TriangleMesh& mesh,
                                   const std::vector<uint32_t>& order) const {
  const std::lock_guard lock(making_);
  if (!tree_) {
    tree_ = std::make_unique<const WideTree>(nodes, mesh, order);
    made_.store(tree_.get(), std::memory_order_release);
  }
  return *tree_;
}

}  // namespace tumble
