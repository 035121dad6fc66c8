#pragma once
#include "engine/geometry/hierarchy/ray_slabs.hpp"
#include "engine/geometry/hierarchy/tree_layout.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <mutex>

namespace tumble {

/// The boxes of a binary tree with up to four children a node, tested together (Dammertz, Hanika &
/// Keller, "Shallow Bounding Volume Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays",
/// 2008): the grandchildren take the place of the larger children. 128 bytes a node, and 12 bytes a
/// triangle for its vertices in the order of the leaves, to save a cache miss.
class WideTree {
 public:
  /// Four children; a box that is missing is empty and met by nothing.
  struct alignas(64) Node {
    std::array<std::array<float, 4>, 6> bounds;  ///< lowest x, y, z, then highest
    std::array<uint32_t, 4> child;               ///< number of a node, or a leaf
  };

  WideTree(const std::vector<TreeNode<AabbVolume>>& nodes, const TriangleMesh& mesh,
           const std::vector<uint32_t>& order);

  /// Calls leaf(first place, count) for the leaves that the ray may enter, roughly from near to far,
  /// unless the slabs have been shortened to before them.
  template <class Leaf>
  void walk(const RaySlabs& slabs, const Leaf& leaf) const;

  /// The vertices of the triangle at a place of the order.
  const Triangle& triangle(uint32_t place) const { return triangles_[place]; }
  size_t bytes() const {
    return nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(Triangle);
  }

 private:
  struct Entry {
    uint32_t child;
    float at;
  };
  static constexpr uint32_t leaf_bit = 0x80000000u;
  static_assert(TreeLayout::max_leaf_triangles < 8);
  static uint32_t leaf_child(uint32_t start, uint32_t count) {
    return leaf_bit | start << 3 | count;
  }
  static void sort_far_first(Entry* entries, size_t count);
  void prefetch(uint32_t child) const {
    const char* p = child & leaf_bit
                        ? reinterpret_cast<const char*>(&triangles_[(child & ~leaf_bit) >> 3])
                        : reinterpret_cast<const char*>(&nodes_[child]);
    _mm_prefetch(p, _MM_HINT_T0);
    _mm_prefetch(p + 64, _MM_HINT_T0);
  }

  std::vector<Node> nodes_;  ///< the first is the root
  std::vector<Triangle> triangles_;
};

/// A WideTree that is made when it is first asked for; from many threads at once is allowed.
class LazyWideTree {
 public:
  LazyWideTree() = default;
  LazyWideTree(const LazyWideTree&) = delete;
  LazyWideTree& operator=(const LazyWideTree&) = delete;

  const WideTree& over(const std::vector<TreeNode<AabbVolume>>& nodes, const TriangleMesh& mesh,
                       const std::vector<uint32_t>& order) const {
    if (const WideTree* tree = made_.load(std::memory_order_acquire)) return *tree;
    return make(nodes, mesh, order);
  }
  /// Not while others use it.
  void forget() {
    made_.store(nullptr);
    tree_.reset();
  }
  size_t bytes() const {
    const WideTree* tree = made_.load(std::memory_order_acquire);
    return tree ? tree->bytes() : 0;
  }

 private:
  const WideTree& make(const std::vector<TreeNode<AabbVolume>>& nodes, const TriangleMesh& mesh,
                       const std::vector<uint32_t>& order) const;

  mutable std::mutex making_;
  mutable std::unique_ptr<const WideTree> tree_;
  mutable std::atomic<const WideTree*> made_{nullptr};
};

inline void WideTree::sort_far_first(Entry* entries, size_t count) {
  for (size_t i = 1; i < count; ++i) {
    const Entry e = entries[i];
    size_t k = i;
    for (; k > 0 && entries[k - 1].at < e.at; --k) entries[k] = entries[k - 1];
    entries[k] = e;
  }
}

template <class Leaf>
void WideTree::walk(const RaySlabs& slabs, const Leaf& leaf) const {
  const RaySlabs::Four four(slabs);
  std::array<Entry, 3 * TreeLayout::max_depth + 8> stack;
  size_t size = 0;
  Entry at{0, 0};
  while (true) {
    if (at.child & leaf_bit) {
      leaf((at.child & ~leaf_bit) >> 3, at.child & 7);
    } else {
      const Node& n = nodes_[at.child];
      const Float4 entries = four.entries(n.bounds, slabs.limit());
      auto hits = unsigned(greater(Float4(no_entry), entries));
      const auto in = entries.array();
      if (hits != 0 && (hits & (hits - 1)) == 0) {  // one child only
        const auto k = size_t(std::countr_zero(hits));
        at = {n.child[k], in[k]};
        continue;
      }
      const size_t before = size;
      for (; hits != 0; hits &= hits - 1) {
        const auto k = size_t(std::countr_zero(hits));
        prefetch(n.child[k]);
        stack[size++] = {n.child[k], in[k]};
      }
      if (size - before > 1) sort_far_first(&stack[before], size - before);
    }
    do {
      if (size == 0) return;
      at = stack[--size];
    } while (at.at > slabs.limit());
  }
}

}  // namespace tumble
