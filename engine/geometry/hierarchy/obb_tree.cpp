#include "engine/geometry/hierarchy/obb_tree.hpp"

#include "engine/geometry/hierarchy/bounding_tree_distance.hpp"
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/bounding_tree_queries.hpp"
#include "engine/geometry/hierarchy/fit_box.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The distinct vertices of each leaf's triangles relative to the origin, leaf after leaf.
struct LeafPoints {
  std::vector<Float4> points;
  std::vector<uint32_t> starts;  ///< by place in the order; only defined at the ends of leaves

  LeafPoints(const FitInput& in, const std::vector<TreeNode<ObbVolume>>& nodes)
      : starts(in.order.size() + 1) {
    points.reserve(2 * in.order.size());
    for (const auto& n : nodes) {
      if (!n.is_leaf()) continue;
      std::array<uint32_t, 3 * TreeLayout::max_leaf_triangles> seen;
      auto end = seen.begin();
      for (uint32_t k = n.start; k < n.start + n.count; ++k) {
        for (const uint32_t v : in.mesh.triangles[in.order[k]]) {
          if (std::find(seen.begin(), end, v) != end) continue;
          *end++ = v;
          points.push_back(to_float4(in.mesh.vertices[v] - in.origin));
        }
      }
      starts[n.start + n.count] = uint32_t(points.size());
    }
  }
  std::span<const Float4> of(NodeRange range) const {
    return std::span(points).subspan(starts[range.first], starts[range.last] - starts[range.first]);
  }
};

}  // namespace

template class BoundingTree<ObbKind>;

void ObbKind::fit(const FitInput& in, std::vector<TreeNode<ObbVolume>>& nodes) {
  const LeafPoints points(in, nodes);
  std::vector<ExtremePoints> waiting;  // of finished subtrees, as in fit_upwards
  const auto store = [&](uint32_t i, NodeRange range) {
    const FittedBox box = fit_box(points.of(range), tight_axes(waiting.back()));
    const Rows3 by_rows = box.axes.transposed();
    ObbVolume& v = nodes[i];
    for (size_t k = 0; k < 3; ++k) {
      const auto row = by_rows.row[k].array();
      std::copy_n(row.begin(), 3, v.axes.begin() + std::ptrdiff_t(3 * k));
    }
    std::copy_n(box.centre.array().begin(), 3, v.centre.begin());
    std::copy_n(box.half.array().begin(), 3, v.half.begin());
  };
  fit_upwards(
      nodes,
      [&](uint32_t i, NodeRange range) {
        const auto own = points.of(range);
        ExtremePoints extreme(own[0]);
        for (const Float4& p : own.subspan(1)) extreme.include(p);
        waiting.push_back(extreme);
        store(i, range);
      },
      [&](uint32_t i, NodeRange range) {
        const ExtremePoints first = waiting.back();
        waiting.pop_back();
        waiting.back().include(first);
        store(i, range);
      });
}

}  // namespace tumble
