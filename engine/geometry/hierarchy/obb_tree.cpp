#include "engine/geometry/hierarchy/obb_tree.hpp"

#include "engine/geometry/hierarchy/bounding_tree_distance.hpp"
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/bounding_tree_queries.hpp"
#include "engine/geometry/hierarchy/fit_box.hpp"

namespace tumble {

template class BoundingTree<ObbKind>;

void ObbKind::fit(const FitInput& in, std::vector<TreeNode<ObbVolume>>& nodes) {
  const std::vector<Float4> points = ordered_corners(in);
  std::vector<ExtremePoints> waiting;  // of finished subtrees, as in fit_upwards
  const auto store = [&](uint32_t i, NodeRange range) {
    const std::span<const Float4> own(points.data() + 3 * range.first,
                                      3 * (range.last - range.first));
    const FittedBox box = fit_box(own, tight_axes(waiting.back()));
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
        ExtremePoints extreme(points[3 * range.first]);
        for (uint32_t k = 3 * range.first + 1; k < 3 * range.last; ++k) extreme.include(points[k]);
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
