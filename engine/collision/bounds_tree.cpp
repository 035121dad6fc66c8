#include "engine/collision/bounds_tree.hpp"

#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

BoundsTree::BoundsTree(std::span<const Aabb> bounds, Crew* crew) {
  std::vector<BroadPhaseProxy> proxies(bounds.size());
  std::vector<uint32_t> placed;
  placed.reserve(bounds.size());
  for (uint32_t i = 0; i < bounds.size(); ++i) {
    proxies[i] = {bounds[i], true};
    if (can_be_placed(bounds[i]))
      placed.push_back(i);
    else if (!bounds[i].empty())
      beside_.push_back(i);
  }
  if (placed.empty()) return;
  PackedTree tree;
  tree.build(proxies, placed, packing_origin(proxies), crew);

  ids_ = tree.members().ids;
  boxes_.reserve(ids_.size());
  for (const uint32_t i : ids_) boxes_.push_back(bounds[i]);
  nodes_.resize(tree.nodes().size());
  for (size_t n = nodes_.size(); n-- > 0;) {  // children come after their parents
    Node& node = nodes_[n];
    const PackedTree::Node& packed = tree.nodes()[n];
    node = {{}, packed.first, packed.last, packed.right};
    if (node.right != 0) {
      node.box = nodes_[n + 1].box;
      node.box.include(nodes_[node.right].box);
    } else {
      for (uint32_t k = node.first; k < node.last; ++k) node.box.include(boxes_[k]);
    }
  }
  reach_ =
      std::max(nodes_[0].box.min.cwiseAbs().maxCoeff(), nodes_[0].box.max.cwiseAbs().maxCoeff());
}

}  // namespace tumble
