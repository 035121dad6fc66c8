#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"

#include <algorithm>

// One-mesh queries of BoundingTree. Volumes answer with lower bounds that allow for rounding.
namespace tumble {

template <class Kind>
void BoundingTree<Kind>::overlap(const Aabb& box, std::vector<uint32_t>& out) const {
  if (nodes_.empty() || box.empty()) return;
  const size_t before = out.size();
  const typename Kind::BoxTest test(*this, box);
  NodeStack stack;
  stack.push(0);
  while (stack.size > 0) {
    const uint32_t i = stack.pop();
    const Node& n = nodes_[i];
    if (test.apart(n)) continue;
    if (!n.is_leaf()) {
      stack.push(n.start);
      stack.push(i + 1);
      continue;
    }
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      if (triangle_meets_box(*mesh_, order_[k], box)) out.push_back(order_[k]);
    }
  }
  std::sort(out.begin() + std::ptrdiff_t(before), out.end());
}

template <class Kind>
std::optional<MeshRayHit> BoundingTree<Kind>::ray(const Ray& ray, double t_max) const {
  if (nodes_.empty()) return std::nullopt;
  const RayShear shear(ray);
  if (!shear.valid()) return std::nullopt;
  typename Kind::RayTest test(*this, ray);
  std::optional<MeshRayHit> best;
  double limit = t_max;
  test.shorten(limit);

  struct Entry {
    uint32_t node;
    float at;
  };
  std::array<Entry, max_depth + 4> stack;
  size_t size = 0;
  const float at_root = test.entry(nodes_[0]);
  if (at_root < no_entry) stack[size++] = {0, at_root};
  while (size > 0) {
    Entry at = stack[--size];
    if (at.at > test.limit()) continue;
    while (!nodes_[at.node].is_leaf()) {
      Entry near{at.node + 1, test.entry(nodes_[at.node + 1])};
      Entry far{nodes_[at.node].start, test.entry(nodes_[nodes_[at.node].start])};
      if (far.at < near.at) std::swap(near, far);
      at = near;
      if (near.at == no_entry) break;
      if (far.at < no_entry) stack[size++] = far;
    }
    if (at.at == no_entry) continue;
    const Node& n = nodes_[at.node];
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      const uint32_t t = order_[k];
      const auto hit =
          shear.triangle(mesh_->corner(t, 0), mesh_->corner(t, 1), mesh_->corner(t, 2), limit);
      if (!hit || (best && hit->t == best->t && t > best->triangle)) continue;
      best = MeshRayHit{hit->t, t, hit->barycentric, hit->front};
      limit = hit->t;
      test.shorten(limit);
    }
  }
  return best;
}

template <class Kind>
std::optional<MeshPoint> BoundingTree<Kind>::closest(const Vec3& p, double max_distance) const {
  if (nodes_.empty()) return std::nullopt;
  const typename Kind::PointTest test(*this, p);
  std::optional<MeshPoint> best;
  double limit = max_distance * max_distance;

  struct Entry {
    uint32_t node;
    float square;
  };
  std::array<Entry, max_depth + 4> stack;
  size_t size = 0;
  stack[size++] = {0, test.squared_distance(nodes_[0])};
  while (size > 0) {
    const Entry at = stack[--size];
    if (double(at.square) > limit) continue;
    const Node& n = nodes_[at.node];
    if (!n.is_leaf()) {
      Entry near{at.node + 1, test.squared_distance(nodes_[at.node + 1])};
      Entry far{n.start, test.squared_distance(nodes_[n.start])};
      if (far.square < near.square) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
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
    }
  }
  return best;
}

}  // namespace tumble
