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
  /// Four children; a missing child has an empty box that nothing meets.
  struct alignas(64) Node {
    std::array<std::array<float, 4>, 6> bounds;  ///< lowest x, y, z, then highest
    std::array<uint32_t, 4> child;               ///< number of a node, or a leaf
  };

  WideTree(const std::vector<TreeNode<AabbVolume>>& nodes, const TriangleMesh& mesh,
           const std::vector<uint32_t>& order);

  /// Calls leaf(first position, count) for the leaves that the ray may enter, roughly from near to
  /// far, except those beyond the limit that the slabs have by then.
  template <class Leaf>
  void walk(const RaySlabs& slabs, const Leaf& leaf) const;

  /// The vertices of the triangle at a position of the order.
  const Triangle& triangle(uint32_t place) const { return triangles_[place]; }
  size_t bytes() const {
    return nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(Triangle);
  }

 private:
  /// A child and the ray's entry into it, packed into one number that is compared without branches:
  /// the bits of the entry, which is not negative (-0 compares as far: visited late, but not
  /// omitted), above those of the child.
  using Entry = uint64_t;
  static Entry entry(uint32_t child, float at) {
    return uint64_t(std::bit_cast<uint32_t>(at)) << 32 | child;
  }
  static float entered_at(Entry e) { return std::bit_cast<float>(uint32_t(e >> 32)); }
  static constexpr uint32_t leaf_bit = 0x80000000u;
  static_assert(TreeLayout::max_leaf_triangles < 8);
  static uint32_t leaf_child(uint32_t start, uint32_t count) {
    return leaf_bit | start << 3 | count;
  }
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

/// A WideTree that is built on first use; thread-safe.
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
  /// Must not be called while others use it.
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

template <class Leaf>
void WideTree::walk(const RaySlabs& slabs, const Leaf& leaf) const {
  const RaySlabs::Four four(slabs);
  std::array<Entry, 3 * TreeLayout::max_depth + 8> stack;
  size_t size = 0;
  const auto swap_if_nearer = [&stack](size_t far, size_t near) {
    const Entry a = stack[far], b = stack[near];
    stack[far] = std::max(a, b);
    stack[near] = std::min(a, b);
  };
  uint32_t at = 0;
  while (true) {
    if (at & leaf_bit) {
      leaf((at & ~leaf_bit) >> 3, at & 7);
    } else {
      const Node& n = nodes_[at];
      const Float4 entries = four.entries(n.bounds, slabs.limit());
      auto hits = unsigned(greater(Float4(no_entry), entries));
      if (hits != 0) {
        auto k = size_t(std::countr_zero(hits));
        at = n.child[k];
        hits &= hits - 1;
        if (hits == 0) continue;  // one child only
        // The nearest is next; the others are pushed, the furthest first.
        const auto in = entries.array();
        Entry nearest = entry(at, in[k]);
        const size_t bottom = size;
        do {
          k = size_t(std::countr_zero(hits));
          const Entry e = entry(n.child[k], in[k]);
          stack[size++] = std::max(nearest, e);
          nearest = std::min(nearest, e);
          prefetch(n.child[k]);
          hits &= hits - 1;
        } while (hits != 0);
        if (size - bottom > 1) {
          swap_if_nearer(bottom, bottom + 1);
          if (size - bottom > 2) {
            swap_if_nearer(bottom + 1, bottom + 2);
            swap_if_nearer(bottom, bottom + 1);
          }
        }
        at = uint32_t(nearest);
        continue;
      }
    }
    Entry next;
    do {
      if (size == 0) return;
      next = stack[--size];
    } while (entered_at(next) > slabs.limit());
    at = uint32_t(next);
  }
}

}  // namespace tumble
