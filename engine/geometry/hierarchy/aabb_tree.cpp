#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include "engine/geometry/hierarchy/aabb_tree_build.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Depth-first order never holds more than one waiting sibling per level.
struct NodeStack {
  std::array<uint32_t, AabbTree::max_depth + 4> items;
  size_t size = 0;
  void push(uint32_t n) { items[size++] = n; }
  uint32_t pop() { return items[--size]; }
};

/// Squared distance of p from a node's box; 0 inside.
double squared_distance(const AabbTree::Node& node, const Vec3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double low = double(node.min[size_t(k)]) - p[k],
                 high = p[k] - double(node.max[size_t(k)]);
    const double d = std::max(std::max(low, high), 0.0);
    sum += d * d;
  }
  return sum;
}

}  // namespace

AabbTree::AabbTree(std::shared_ptr<const TriangleMesh> mesh) : Hierarchy(std::move(mesh)) {
  if (mesh_->triangles.empty()) return;
  origin_ = bounds_.centre();
  AabbTreeParts parts = build_aabb_tree(*mesh_, origin_);
  nodes_ = std::move(parts.nodes);
  order_ = std::move(parts.order);
  depth_ = parts.depth;
  slack_ = 1e-14 * (bounds_.extent().norm() + origin_.norm());
}

size_t AabbTree::state_bytes() const {
  return nodes_.size() * sizeof(Node) + order_.size() * sizeof(uint32_t);
}

Aabb AabbTree::node_box(uint32_t node) const {
  const Node& n = nodes_[node];
  return {origin_ + Vec3(double(n.min[0]), double(n.min[1]), double(n.min[2])),
          origin_ + Vec3(double(n.max[0]), double(n.max[1]), double(n.max[2]))};
}

void AabbTree::overlap(const Aabb& box, std::vector<uint32_t>& out) const {
  if (nodes_.empty() || box.empty()) return;
  const size_t before = out.size();
  const double slack = slack_ + 1e-15 * (box.min.norm() + box.max.norm());
  const Vec3 low = box.min.array() - origin_.array() - slack;
  const Vec3 high = box.max.array() - origin_.array() + slack;
  NodeStack stack;
  stack.push(0);
  while (stack.size > 0) {
    const uint32_t i = stack.pop();
    const Node& n = nodes_[i];
    bool apart = false;
    for (int k = 0; k < 3; ++k) {
      apart = apart || double(n.min[size_t(k)]) > high[k] || double(n.max[size_t(k)]) < low[k];
    }
    if (apart) continue;
    if (!n.is_leaf()) {
      stack.push(n.start);
      stack.push(i + 1);
      continue;
    }
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      if (triangle_bounds(*mesh_, order_[k]).overlaps(box)) out.push_back(order_[k]);
    }
  }
  std::sort(out.begin() + std::ptrdiff_t(before), out.end());
}

std::optional<MeshRayHit> AabbTree::ray(const Ray& ray, double t_max) const {
  if (nodes_.empty()) return std::nullopt;
  const RayShear shear(ray);
  if (!shear.valid()) return std::nullopt;
  const double slack = slack_ + 1e-14 * ray.origin.norm();
  const Vec3 start = ray.origin - origin_;
  const Vec3 inverse = ray.direction.cwiseInverse();
  std::optional<MeshRayHit> best;
  double limit = t_max;

  // Entry of the ray into a node, or infinity; rounding is allowed for on the safe side.
  const auto entry = [&](const Node& n) {
    double t0 = 0, t1 = limit;
    for (int k = 0; k < 3; ++k) {
      const double low = double(n.min[size_t(k)]) - slack - start[k];
      const double high = double(n.max[size_t(k)]) + slack - start[k];
      if (ray.direction[k] == 0) {
        if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
        continue;
      }
      const double a = low * inverse[k], b = high * inverse[k];
      const double near = std::min(a, b), far = std::max(a, b);
      t0 = std::max(t0, near * (near > 0 ? 1 - 1e-14 : 1 + 1e-14));
      t1 = std::min(t1, far * (far > 0 ? 1 + 1e-14 : 1 - 1e-14));
    }
    return t0 <= t1 * (1 + 1e-13) ? t0 : std::numeric_limits<double>::infinity();
  };

  NodeStack stack;
  stack.push(0);
  while (stack.size > 0) {
    const uint32_t i = stack.pop();
    const Node& n = nodes_[i];
    if (!(entry(n) <= limit * (1 + 1e-13))) continue;
    if (!n.is_leaf()) {
      const bool second_first = entry(nodes_[n.start]) < entry(nodes_[i + 1]);
      stack.push(second_first ? i + 1 : n.start);
      stack.push(second_first ? n.start : i + 1);
      continue;
    }
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      const uint32_t t = order_[k];
      const auto hit =
          shear.triangle(mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2), limit);
      if (!hit || (best && hit->t == best->t && t > best->triangle)) continue;
      best = MeshRayHit{hit->t, t, hit->barycentric, hit->front};
      limit = hit->t;
    }
  }
  return best;
}

std::optional<MeshPoint> AabbTree::closest(const Vec3& p, double max_distance) const {
  if (nodes_.empty()) return std::nullopt;
  const Vec3 local = p - origin_;
  const double slack = slack_ + 1e-14 * p.norm();
  std::optional<MeshPoint> best;
  double limit = max_distance * max_distance;
  const auto padded = [&] {
    const double d = std::sqrt(limit) * (1 + 1e-13) + slack;
    return d * d;
  };
  double prune = padded();
  NodeStack stack;
  stack.push(0);
  while (stack.size > 0) {
    const uint32_t i = stack.pop();
    const Node& n = nodes_[i];
    if (!(squared_distance(n, local) <= prune)) continue;
    if (!n.is_leaf()) {
      const bool second_first =
          squared_distance(nodes_[n.start], local) < squared_distance(nodes_[i + 1], local);
      stack.push(second_first ? i + 1 : n.start);
      stack.push(second_first ? n.start : i + 1);
      continue;
    }
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      const uint32_t t = order_[k];
      const TrianglePoint near =
          closest_on_triangle(p, mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2));
      if (!(near.squared_distance <= limit)) continue;
      if (best && near.squared_distance == best->squared_distance && t > best->triangle) continue;
      best = MeshPoint{near.point, t, near.barycentric, near.feature, near.squared_distance};
      limit = near.squared_distance;
      prune = padded();
    }
  }
  return best;
}

}  // namespace tumble
