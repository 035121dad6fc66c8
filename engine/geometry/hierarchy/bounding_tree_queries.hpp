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

/// Calls leaf(first place, count) for the leaves that the ray may enter, nearest child first.
template <class Nodes, class RayTest, class Leaf>
void walk_ray(const Nodes& nodes, const RayTest& test, const Leaf& leaf) {
  struct Entry {
    uint32_t node;
    float at;
  };
  std::array<Entry, TreeLayout::max_depth + 4> stack;
  size_t size = 0;
  const float at_root = test.entry(nodes[0]);
  if (at_root < no_entry) stack[size++] = {0, at_root};
  while (size > 0) {
    Entry at = stack[--size];
    if (at.at > test.limit()) continue;
    while (!nodes[at.node].is_leaf()) {
      Entry near{at.node + 1, test.entry(nodes[at.node + 1])};
      Entry far{nodes[at.node].start, test.entry(nodes[nodes[at.node].start])};
      if (far.at < near.at) std::swap(near, far);
      at = near;
      if (near.at == no_entry) break;
      if (far.at < no_entry) stack[size++] = far;
    }
    if (at.at < no_entry) leaf(nodes[at.node].start, nodes[at.node].count);
  }
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
  const auto try_triangle = [&](uint32_t place, const Triangle& v) {
    const auto& at = mesh_->vertices;
    const auto hit = shear.triangle(at[v[0]], at[v[1]], at[v[2]], limit);
    if (!hit) return;
    const uint32_t t = order_[place];
    if (best && hit->t == best->t && t > best->triangle) return;
    best = MeshRayHit{hit->t, t, hit->barycentric, hit->front};
    limit = hit->t;
    test.shorten(limit);
  };
  if constexpr (std::is_same_v<Volume, AabbVolume>) {
    const WideTree& wide = kind_.wide({*mesh_, origin_, order_}, nodes_);
    wide.walk(test.slabs(), [&](uint32_t first, uint32_t count) {
      for (uint32_t k = first; k < first + count; ++k) try_triangle(k, wide.triangle(k));
    });
  } else {
    walk_ray(nodes_, test, [&](uint32_t first, uint32_t count) {
      for (uint32_t k = first; k < first + count; ++k) try_triangle(k, mesh_->triangles[order_[k]]);
    });
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
