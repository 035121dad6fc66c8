#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include "engine/geometry/hierarchy/bounding_tree_distance.hpp"
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/bounding_tree_queries.hpp"

#include <algorithm>

namespace tumble {
namespace {

void include(AabbVolume& box, const AabbVolume& other) {
  for (size_t k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], other.min[k]);
    box.max[k] = std::max(box.max[k], other.max[k]);
  }
}

/// The bounding boxes of a leaf's triangles, in their own frame and in the other mesh's.
struct LeafBoxes {
  std::array<Aabb, AabbTree::max_leaf_triangles> own, other;
};

template <class Map>
LeafBoxes leaf_boxes(const AabbTree& tree, const AabbTree::Node& leaf, double margin,
                     const Map& to_other) {
  LeafBoxes out;
  for (uint32_t i = 0; i < leaf.count; ++i) {
    const uint32_t t = tree.triangle_order()[leaf.start + i];
    out.own[i] = triangle_bounds(tree.mesh(), t).inflated(margin);
    for (size_t k = 0; k < 3; ++k) out.other[i].include(to_other(tree.mesh().corner(t, k)));
  }
  return out;
}

}  // namespace

template class BoundingTree<AabbKind>;

void AabbKind::fit(const FitInput& in, std::vector<TreeNode<AabbVolume>>& nodes) {
  wide_.forget();
  fit_upwards(
      nodes,
      [&](uint32_t i, NodeRange range) {
        AabbVolume box = rounded_box(in.mesh, in.order[range.first], in.origin);
        for (uint32_t k = range.first + 1; k < range.last; ++k) {
          include(box, rounded_box(in.mesh, in.order[k], in.origin));
        }
        static_cast<AabbVolume&>(nodes[i]) = box;
      },
      [&](uint32_t i, NodeRange) {
        AabbVolume box = nodes[i + 1];
        include(box, nodes[nodes[i].start]);
        static_cast<AabbVolume&>(nodes[i]) = box;
      });
}

Aabb node_box(const AabbTree& tree, uint32_t node) {
  const auto& n = tree.nodes()[node];
  return {tree.origin() + Vec3f(n.min.data()).cast<double>(),
          tree.origin() + Vec3f(n.max.data()).cast<double>()};
}

void box_pairs(const AabbTree& ta, const AabbTree& tb, const Pose& b_in_a, double margin,
               std::vector<TriangleIds>& out) {
  const size_t before = out.size();
  const AabbKind::PairTest<false> test(ta, tb, RelativePose(b_in_a), margin, Vec3::Zero());
  const auto leaves = [&](const AabbTree::Node& na, const AabbTree::Node& nb) {
    const LeafBoxes a =
        leaf_boxes(ta, na, margin, [&](const Vec3& p) { return b_in_a.inverse_point(p); });
    const LeafBoxes b = leaf_boxes(tb, nb, margin, [&](const Vec3& p) { return b_in_a.point(p); });
    for (uint32_t i = 0; i < na.count; ++i) {
      for (uint32_t j = 0; j < nb.count; ++j) {
        if (a.own[i].overlaps(b.other[j]) && b.own[j].overlaps(a.other[i])) {
          out.push_back({ta.triangle_order()[na.start + i], tb.triangle_order()[nb.start + j]});
        }
      }
    }
    return true;
  };
  traverse<false>(
      ta, tb, [&](const auto& a, const auto& b) { return test.faces_apart(a, b); }, leaves);
  std::sort(out.begin() + std::ptrdiff_t(before), out.end());
}

}  // namespace tumble
