#include "engine/geometry/wrap/changing_tree.hpp"

#include "engine/core/stop.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

constexpr uint32_t leaf_size = 4;  ///< as in the trees of queries: fewer double the nodes

}  // namespace

ChangingTree::ChangingTree(const TriangleMesh& mesh) {
  const size_t count = mesh.triangles.size();
  order_.resize(count), boxes_.resize(count), place_.resize(count), leaf_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3> middle(count);
  for (uint32_t t = 0; t < count; ++t)
    middle[t] = mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2);
  if (count > 0) nodes_.push_back({{}, 0, uint32_t(count), no_index, no_index});
  // Halves of equal numbers along the longest side of the middles, so its depth is bounded.
  for (uint32_t i = 0; i < nodes_.size(); ++i) {
    const Node n = nodes_[i];
    const auto first = order_.begin() + n.first, last = first + n.count;
    if (n.count <= leaf_size || stop_requested()) continue;
    Aabb around;
    for (auto it = first; it != last; ++it) around.include(middle[*it]);
    const Vec3 extent = around.extent();
    const int k = extent.x() >= extent.y() && extent.x() >= extent.z() ? 0
                  : extent.y() >= extent.z()                           ? 1
                                                                       : 2;
    const uint32_t half = n.count / 2;
    std::nth_element(first, first + half, last, [&](uint32_t a, uint32_t b) {
      return middle[a][k] != middle[b][k] ? middle[a][k] < middle[b][k] : a < b;
    });
    nodes_[i].left = uint32_t(nodes_.size());
    nodes_.push_back({{}, n.first, half, no_index, i});
    nodes_.push_back({{}, n.first + half, n.count - half, no_index, i});
  }
  for (uint32_t k = 0; k < count; ++k) {
    place_[order_[k]] = k;
    boxes_[k] = triangle_bounds(mesh, order_[k]);
  }
  // Children come after their parents.
  for (uint32_t i = uint32_t(nodes_.size()); i-- > 0;) {
    Node& n = nodes_[i];
    if (n.left != no_index) {
      n.box = nodes_[n.left].box;
      n.box.include(nodes_[n.left + 1].box);
      continue;
    }
    for (uint32_t k = n.first; k < n.first + n.count; ++k) {
      leaf_[k] = i;
      n.box.include(boxes_[k]);
    }
  }
}

void ChangingTree::set(uint32_t triangle, const Aabb& box) {
  const uint32_t place = place_[triangle];
  boxes_[place] = box;
  for (uint32_t i = leaf_[place]; i != no_index; i = nodes_[i].parent) {
    Node& n = nodes_[i];
    Aabb around;
    if (n.left != no_index) {
      around = nodes_[n.left].box;
      around.include(nodes_[n.left + 1].box);
    } else {
      for (uint32_t k = n.first; k < n.first + n.count; ++k) around.include(boxes_[k]);
    }
    if (around.min == n.box.min && around.max == n.box.max) return;
    n.box = around;
  }
}

}  // namespace tumble
