#include "engine/geometry/hierarchy/tree_layout.hpp"

#include "engine/geometry/hierarchy/tree_items.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace tumble {
namespace {

constexpr int most_bins = 16;
/// Number of bins: small nodes get fewer, since bins would cost more than the triangles.
int bins_for(uint32_t triangles) {
  return triangles < 32 ? 4 : triangles < 256 ? 8 : most_bins;
}
/// From this depth on nodes are halved at the median, which ends within 32 levels.
constexpr int forced_median_depth = 60;
/// Nodes of at most this many triangles are halved at the median: the surface area heuristic costs
/// more than it gains.
constexpr uint32_t small_node = 8;
/// Larger nodes are only split along the longest axis of their centroids.
constexpr uint32_t large_node = 256;

struct Bin {
  GrowingBox box;
  uint32_t count = 0;
};

class Builder {
 public:
  Builder(const TriangleMesh& mesh, const Vec3& origin, TreeBuilder builder) : builder_(builder) {
    items_.resize(mesh.triangles.size());
    for (uint32_t t = 0; t < items_.size(); ++t) {
      items_[t] = TreeItem::make(outward_box(mesh, t, origin), t);
    }
  }

  TreeLayout build() {
    TreeItems all = measured(0, uint32_t(items_.size()));
    struct Task {
      TreeItems range;
      uint32_t parent;  // the node whose second child this is, or no_index
      int depth;
    };
    std::vector<Task> tasks;
    if (!items_.empty()) tasks.push_back({all, no_index, 0});
    out_.nodes.reserve(items_.size() * 11 / 16 + 1);  // mostly enough
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const auto node = uint32_t(out_.nodes.size());
      if (task.parent != no_index) out_.nodes[task.parent].start = node;
      out_.depth = std::max(out_.depth, task.depth);
      store(task.range);
      if (task.range.size() <= TreeLayout::max_leaf_triangles) continue;
      const auto [left, right] = divide(task.range, task.depth);
      tasks.push_back({right, node, task.depth + 1});
      tasks.push_back({left, no_index, task.depth + 1});
    }
    if (out_.nodes.size() < out_.nodes.capacity() / 4 * 3) out_.nodes.shrink_to_fit();
    out_.order.resize(items_.size());
    for (size_t i = 0; i < items_.size(); ++i) out_.order[i] = items_[i].triangle();
    for (const auto& node : out_.nodes) {
      const auto first = out_.order.begin() + node.start;
      if (node.is_leaf()) std::sort(first, first + node.count);
    }
    return std::move(out_);
  }

 private:
  void store(const TreeItems& range) {
    const auto low = range.box.min.array(), high = range.box.max.array();
    const bool leaf = range.size() <= TreeLayout::max_leaf_triangles;
    out_.nodes.push_back({{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}},
                          leaf ? range.begin : 0,
                          leaf ? range.size() : 0});
  }

  TreeItems measured(uint32_t begin, uint32_t end) const {
    TreeItems r{begin, end, {}, {}};
    for (uint32_t i = begin; i < end; ++i) {
      r.box.include(items_[i].box);
      r.centres.include(items_[i].centre());
    }
    return r;
  }

  /// Fills the bins of all axes in one pass and returns the cheapest split between two bins.
  TreeSplit cheapest(const TreeItems& range) {
    const int bins = bins_for(range.size());
    const Float4 low = range.centres.min, width = range.centres.max - range.centres.min;
    // Slightly less than `bins`, so that the last centroid falls into the last bin.
    const Float4 tiny(std::numeric_limits<float>::min() * most_bins);
    const Float4 scale = _mm_div_ps(Float4(float(bins) * 0.99999f).v, max(width, tiny).v);
    // Large nodes usually have one longest axis; the other axes would take two thirds of the time.
    const bool large = range.size() > large_node;
    const int first = large ? range.centres.longest_axis() : 0, last = large ? first + 1 : 3;
    for (int axis = first; axis < last; ++axis) {
      std::fill_n(table_[size_t(axis)].begin(), bins, Bin{});
    }
    for (uint32_t i = range.begin; i < range.end; ++i) {
      const GrowingBox box = items_[i].box;
      std::array<int32_t, 4> at;
      _mm_storeu_si128(reinterpret_cast<__m128i*>(at.data()),
                       TreeSplit::bins_of(items_[i], low, scale));
      for (size_t axis = size_t(first); axis < size_t(last); ++axis) {
        Bin& b = table_[axis][size_t(at[axis])];
        b.box.include(box);
        ++b.count;
      }
    }
    TreeSplit best;
    for (int axis = first; axis < last; ++axis)
      weigh({table_[size_t(axis)].data(), size_t(bins)}, axis, best);
    best.low = low;
    best.scale = scale;
    return best;
  }

  static void weigh(std::span<const Bin> table, int axis, TreeSplit& best) {
    const auto bins = table.size();
    std::array<float, most_bins> right_cost;
    std::array<GrowingBox, most_bins> right_box;
    GrowingBox box;
    uint32_t count = 0;
    for (size_t b = bins - 1; b > 0; --b) {
      box.include(table[b].box);
      count += table[b].count;
      right_cost[b] = count > 0 ? box.half_area() * float(count) : -1;
      right_box[b] = box;
    }
    box = {};
    count = 0;
    for (size_t b = 0; b + 1 < bins; ++b) {
      box.include(table[b].box);
      count += table[b].count;
      if (count == 0 || right_cost[b + 1] < 0) continue;
      const float cost = box.half_area() * float(count) + right_cost[b + 1];
      if (cost < best.cost) {
        best.cost = cost;
        best.axis = axis;
        best.bin = int(b + 1);
        best.left_box = box;
        best.right_box = right_box[b + 1];
      }
    }
  }

  /// Partitions without branches, because the side of an item is unpredictable.
  template <class Left>
  std::pair<TreeItems, TreeItems> partition(const TreeItems& range, const GrowingBox& left_box,
                                            const GrowingBox& right_box, const Left& left) {
    TreeItems a{range.begin, range.begin, left_box, {}}, b{range.begin, range.end, right_box, {}};
    for (uint32_t i = range.begin; i < range.end; ++i) {
      const TreeItem item = items_[i];
      const bool to_left = left(item);
      // Where a bound must not change it is combined with NaN as first operand, which min and max
      // ignore.
      const Float4 to_a(_mm_castsi128_ps(_mm_set1_epi32(int(to_left) - 1)));
      const Float4 to_b(_mm_castsi128_ps(_mm_set1_epi32(-int(to_left))));
      const Float4 centre = item.centre();
      const Float4 of_a = _mm_or_ps(centre.v, to_a.v), of_b = _mm_or_ps(centre.v, to_b.v);
      a.centres = {min(of_a, a.centres.min), max(of_a, a.centres.max)};
      b.centres = {min(of_b, b.centres.min), max(of_b, b.centres.max)};
      items_[i] = items_[a.end];
      items_[a.end] = item;
      a.end += to_left;
    }
    b.begin = a.end;
    return {a, b};
  }

  /// Halves a node whose halves are leaves, by rank.
  std::pair<TreeItems, TreeItems> small_halves(const TreeItems& range) {
    const int axis = range.centres.longest_axis();
    const uint32_t n = range.size(), half = n / 2;
    std::array<TreeItem, small_node> items;
    std::array<float, small_node> keys;
    for (uint32_t i = 0; i < n; ++i) {
      items[i] = items_[range.begin + i];
      keys[i] = items[i].centre().array()[size_t(axis)];
    }
    TreeItems a{range.begin, range.begin, {}, {}},
        b{range.begin + half, range.begin + half, {}, {}};
    for (uint32_t i = 0; i < n; ++i) {
      uint32_t rank = 0;
      for (uint32_t j = 0; j < n; ++j) rank += keys[j] < keys[i] || (keys[j] == keys[i] && j < i);
      TreeItems& side = rank < half ? a : b;
      side.box.include(items[i].box);
      items_[side.end++] = items[i];
    }
    return {a, b};
  }

  std::pair<TreeItems, TreeItems> halves(const TreeItems& range) {
    if (range.size() <= small_node) return small_halves(range);
    const int axis = range.centres.longest_axis();
    const uint32_t middle = range.begin + range.size() / 2;
    const auto key = [axis](const TreeItem& i) { return i.centre().array()[size_t(axis)]; };
    std::nth_element(items_.begin() + range.begin, items_.begin() + middle,
                     items_.begin() + range.end, [&](const TreeItem& a, const TreeItem& b) {
                       const float x = key(a), y = key(b);
                       return x != y ? x < y : a.triangle() < b.triangle();
                     });
    return {measured(range.begin, middle), measured(middle, range.end)};
  }

  std::pair<TreeItems, TreeItems> at_mean(const TreeItems& range) {
    const auto axis = size_t(range.box.longest_axis());
    double sum = 0;
    for (uint32_t i = range.begin; i < range.end; ++i) {
      sum += double(items_[i].centre().array()[axis]);
    }
    const auto mean = float(sum / range.size());
    const auto left = [&](const TreeItem& i) { return i.centre().array()[axis] < mean; };
    GrowingBox left_box, right_box;
    for (uint32_t i = range.begin; i < range.end; ++i) {
      (left(items_[i]) ? left_box : right_box).include(items_[i].box);
    }
    return partition(range, left_box, right_box, left);
  }

  std::pair<TreeItems, TreeItems> divide(const TreeItems& range, int depth) {
    if (depth < forced_median_depth) {
      if (builder_ == TreeBuilder::longest_axis) {
        const auto sides = at_mean(range);
        if (sides.first.size() > 0 && sides.second.size() > 0) return sides;
      } else if (range.size() > small_node) {
        const TreeSplit split = cheapest(range);
        if (split.axis >= 0) {
          const auto sides = partition(range, split.left_box, split.right_box,
                                       [&](const TreeItem& i) { return split.left(i); });
          if (sides.first.size() > 0 && sides.second.size() > 0) return sides;
        }
      }
    }
    return halves(range);
  }

  TreeBuilder builder_;
  std::vector<TreeItem> items_;
  std::array<std::array<Bin, most_bins>, 3> table_;
  TreeLayout out_;
};

}  // namespace

AabbVolume rounded_box(const TriangleMesh& mesh, uint32_t triangle, const Vec3& origin) {
  const GrowingBox box = outward_box(mesh, triangle, origin);
  const auto low = box.min.array(), high = box.max.array();
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

TreeLayout build_tree_layout(const TriangleMesh& mesh, const Vec3& origin, TreeBuilder builder) {
  return Builder(mesh, origin, builder).build();
}

}  // namespace tumble
