#pragma once
#include "engine/geometry/hierarchy/aabb_kind.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <type_traits>

namespace tumble {

/// Binary tree of bounding volumes over the triangles of a mesh, stored in depth-first order.
/// `Kind` defines the volumes; division, traversal and decisions are the same for all (README).
template <class Kind>
class BoundingTree final : public Hierarchy {
 public:
  using Volume = typename Kind::Volume;
  using Node = TreeNode<Volume>;
  static constexpr uint32_t max_leaf_triangles = TreeLayout::max_leaf_triangles;
  static constexpr int max_depth = TreeLayout::max_depth;

  explicit BoundingTree(std::shared_ptr<const TriangleMesh> mesh, const TreeOptions& options = {});

  std::string_view name() const override { return Kind::name; }
  size_t state_bytes() const override {
    return nodes_.size() * sizeof(Node) + order_.size() * sizeof(uint32_t) + kind_.state_bytes();
  }
  int depth() const override { return depth_; }
  size_t node_count() const override { return nodes_.size(); }
  void visit_nodes(const std::function<bool(const NodeBound&)>& visit) const override;

  void overlap(const Aabb& box, std::vector<uint32_t>& out) const override;
  std::optional<MeshRayHit> ray(const Ray& ray, double t_max) const override;
  std::optional<MeshPoint> closest(const Vec3& p, double max_distance) const override;
  void pairs(const Hierarchy& other, const Pose& other_pose, double margin,
             std::vector<TriangleIds>& out, HierarchyStatistics* cost = nullptr) const override;
  bool intersects(const Hierarchy& other, const Pose& other_pose,
                  HierarchyStatistics* cost = nullptr) const override;
  void self_pairs(double margin, std::vector<TriangleIds>& out,
                  HierarchyStatistics* cost = nullptr) const override;
  std::optional<MeshDistance> distance(const Hierarchy& other, const Pose& other_pose,
                                       double max_distance,
                                       HierarchyStatistics* cost = nullptr) const override;
  void swept_pairs(const Hierarchy& other, const SweptQuery& query, std::vector<TriangleIds>& out,
                   HierarchyStatistics* cost = nullptr) const override;

  const std::vector<Node>& nodes() const { return nodes_; }
  std::span<const uint32_t> triangle_order() const override { return order_; }
  /// Origin of the volumes, in the mesh's frame.
  const Vec3& origin() const { return origin_; }
  const Kind& kind() const { return kind_; }
  /// Of two nodes the one of greater size is descended into first.
  static float size_of(const Node& n) { return Kind::size_of(n); }
  /// Diagonal of the mesh's box [m].
  double size() const { return bounds_.extent().norm(); }
  /// Bound of the rounding error by which a volume may miss a point [m], from coordinates about the
  /// origin.
  double slack() const { return 1e-14 * (size() + origin_.norm()); }

 private:
  void refit_nodes() override;

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
  Vec3 origin_ = Vec3::Zero();
  int depth_ = 0;
  Kind kind_;
};

/// Range of positions in the triangle order that a node covers: [first, last).
struct NodeRange {
  uint32_t first, last;
};

/// The children of a node have greater indices than the node: iterating backwards visits them
/// before their parent. Calls `leaf(i, range)` or `inner(i, range)` for every node, children first.
template <class Nodes, class Leaf, class Inner>
void fit_upwards(const Nodes& nodes, const Leaf& leaf, const Inner& inner) {
  std::vector<NodeRange> done;  // of the finished subtrees that await their parent, nearest last
  for (size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].is_leaf()) {
      done.push_back({nodes[i].start, nodes[i].start + nodes[i].count});
      leaf(uint32_t(i), done.back());
      continue;
    }
    const NodeRange first = done.back();
    done.pop_back();
    done.back().first = first.first;  // the first child's triangles stand before the second's
    inner(uint32_t(i), done.back());
  }
}

/// Depth-first order never holds more than one waiting sibling per level.
struct NodeStack {
  std::array<uint32_t, TreeLayout::max_depth + 4> items;
  size_t size = 0;
  void push(uint32_t n) { items[size++] = n; }
  uint32_t pop() { return items[--size]; }
};

template <class Kind>
BoundingTree<Kind>::BoundingTree(std::shared_ptr<const TriangleMesh> mesh,
                                 const TreeOptions& options)
    : Hierarchy(std::move(mesh)) {
  if (mesh_->triangles.empty()) return;
  origin_ = bounds_.centre();
  TreeLayout layout = build_tree_layout(*mesh_, origin_, options.builder);
  order_ = std::move(layout.order);
  depth_ = layout.depth;
  if constexpr (std::is_same_v<Volume, AabbVolume>) {
    nodes_ = std::move(layout.nodes);
  } else {
    nodes_.resize(layout.nodes.size());
    for (size_t i = 0; i < nodes_.size(); ++i) {
      nodes_[i].start = layout.nodes[i].start;
      nodes_[i].count = layout.nodes[i].count;
    }
    kind_.fit(FitInput{*mesh_, origin_, order_}, nodes_);
  }
}

template <class Kind>
void BoundingTree<Kind>::refit_nodes() {
  if (nodes_.empty()) return;
  origin_ = bounds_.centre();
  kind_.fit(FitInput{*mesh_, origin_, order_}, nodes_);
}

template <class Kind>
void BoundingTree<Kind>::visit_nodes(const std::function<bool(const NodeBound&)>& visit) const {
  struct Place {
    uint32_t node;
    int level;
    NodeRange range;
  };
  std::vector<Place> stack;
  if (!nodes_.empty()) stack.push_back({0, 0, {0, uint32_t(order_.size())}});
  NodeBound bound;
  while (!stack.empty()) {
    const Place at = stack.back();
    stack.pop_back();
    const Node& n = nodes_[at.node];
    bound.level = at.level;
    bound.leaf = n.is_leaf();
    bound.triangles = {order_.data() + at.range.first, at.range.last - at.range.first};
    kind_.bound(*this, n, bound);
    if (!visit(bound) || n.is_leaf()) continue;
    uint32_t left = n.start;  // the leaf that holds the second child's first triangle
    while (!nodes_[left].is_leaf()) ++left;
    const uint32_t split = nodes_[left].start;
    stack.push_back({n.start, at.level + 1, {split, at.range.last}});
    stack.push_back({at.node + 1, at.level + 1, {at.range.first, split}});
  }
}

}  // namespace tumble
