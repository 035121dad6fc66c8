#include "engine/geometry/hull/plane_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

constexpr uint32_t planes_in_leaf = 6;

}  // namespace

PlaneTree::PlaneTree(std::span<const Plane> planes, std::vector<Vec3> touched)
    : planes_(planes), touched_(std::move(touched)), order_(planes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  double largest = 0;
  for (const Vec3& p : touched_) largest = std::max(largest, p.norm());
  slack_ = 1e-14 * largest;
  nodes_.reserve(planes.size());
  if (!planes.empty()) build(0, uint32_t(planes.size()));
}

void PlaneTree::build(uint32_t begin, uint32_t end) {
  Aabb normals;
  Vec3 sum = Vec3::Zero();
  double offset = std::numeric_limits<double>::infinity();
  const Vec3 anchor = touched_[order_[begin + (end - begin) / 2]];
  for (uint32_t i = begin; i < end; ++i) {
    const Plane& p = planes_[order_[i]];
    normals.include(p.normal);
    sum += p.normal;
    offset = std::min(offset, -p.distance(anchor));
  }
  const Vec3 axis = sum.squaredNorm() > 0 ? Vec3(sum.normalized()) : Vec3::UnitX();
  double chord = 0;
  for (uint32_t i = begin; i < end; ++i) {
    chord = std::max(chord, (planes_[order_[i]].normal - axis).norm());
  }
  const size_t self = nodes_.size();
  nodes_.push_back({axis, std::min(chord, 1.0) + 1e-15, 1 - 0.5 * chord * chord - 1e-15, anchor,
                    offset, begin, end, 0});
  if (end - begin <= planes_in_leaf) return;
  int widest;
  normals.extent().maxCoeff(&widest);
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     return planes_[a].normal[widest] < planes_[b].normal[widest];
                   });
  build(begin, middle);
  nodes_[self].right = uint32_t(nodes_.size());
  build(middle, end);
}

uint32_t PlaneTree::first_outside(const Vec3& p, double epsilon) const {
  uint32_t first = no_index;
  if (nodes_.empty()) return first;
  const double slack = slack_ + 1e-14 * p.norm();
  uint32_t stack[64];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    const Vec3 q = p - node.anchor;
    // For a normal at angle t from the axis: n.q = cos t (axis.q) + sin t times at most the
    // perpendicular component.
    const double along = node.axis.dot(q);
    const double across = (q - along * node.axis).norm();
    const double most = along * (along > 0 ? 1 : node.cosine) + across * node.sine;
    if (most - node.offset + slack <= epsilon) continue;
    if (node.right) {
      stack[top++] = uint32_t(&node - nodes_.data()) + 1;
      stack[top++] = node.right;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      if (planes_[order_[i]].distance(p) > epsilon) first = std::min(first, order_[i]);
    }
  }
  return first;
}

}  // namespace tumble
