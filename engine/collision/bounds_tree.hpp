#pragma once
#include "engine/core/crew.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

namespace tumble {

/// A bounding volume tree over bounds at rest, which finds those that a ray, a moving box, a box or
/// a point may meet. It visits all that are met and few others; callers decide exactly. It is
/// divided as PackedTree is, but stores boxes in double precision, so that large distances cost no
/// accuracy. Infinite bounds and those beyond 10^30 m are kept in a separate list and visited
/// first; empty ones are left out. Queries are const and may run in many threads; the order of
/// visits is the same every time.
class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(std::span<const Aabb> bounds, Crew* crew = nullptr);

  /// Bounds of all members; infinite if one of them is infinite.
  Aabb bounds() const;

  /// Visits the bounds that a box of half extents `half` (>= 0) meets while its centre moves along
  /// the ray for t in [0, t_max]; with half zero, those that the ray meets. The nearer of two
  /// branches comes first. `visit(i)` returns the new t_max, which may only decrease; a value below
  /// 0 ends the search.
  template <class Visit>
  void along(const Ray& ray, const Vec3& half, double t_max, const Visit& visit) const;

  /// Visits the bounds that have a point in common with the box; visit(i) returns whether to go on.
  template <class Visit>
  void overlapping(const Aabb& box, const Visit& visit) const;

  /// Visits the bounds no farther from x than `reach` (>= 0) [m], the nearer of two branches first;
  /// visit(i) returns the new reach, which may only decrease.
  template <class Visit>
  void around(const Vec3& x, double reach, const Visit& visit) const;

 private:
  struct Node {
    Aabb box;
    uint32_t first = 0, last = 0;  ///< members below
    uint32_t right = 0;            ///< the left child follows its parent; 0 in a leaf
  };
  struct Branch {
    double at;  ///< entry parameter or distance of its box
    uint32_t node;
  };
  /// Stack of branches to visit, in a local buffer that nearly always suffices.
  class Waiting {
   public:
    Waiting() { branches_.reserve(120); }
    void push(double at, uint32_t node) { branches_.push_back({at, node}); }
    bool empty() const { return branches_.empty(); }
    Branch pop() {
      const Branch b = branches_.back();
      branches_.pop_back();
      return b;
    }

   private:
    std::array<std::byte, 2048> buffer_;
    std::pmr::monotonic_buffer_resource memory_{buffer_.data(), buffer_.size()};
    std::pmr::vector<Branch> branches_{&memory_};
  };

  static constexpr double missed = std::numeric_limits<double>::infinity();

  /// A box that moves along a ray, for tests against bounds at rest (slab method).
  struct Sweep {
    Vec3 origin, inverse, half;
    /// The ray parameter at which it enters the bounds, or `missed`. Along an axis without motion
    /// `inverse` is +infinity, and the slab's sides give infinities, or NaN if the origin is
    /// exactly on a side; comparisons with NaN are false, so that it is ignored.
    double entry(const Aabb& b, double t_max) const {
      double in = 0, out = t_max;
      for (int k = 0; k < 3; ++k) {
        const double s = (b.min[k] - half[k] - origin[k]) * inverse[k];
        const double t = (b.max[k] + half[k] - origin[k]) * inverse[k];
        in = std::max(in, t < s ? t : s);
        out = std::min(out, t < s ? s : t);
      }
      return in <= out ? in : missed;
    }
  };

  /// Descends the tree with `meet(box, limit)`, which returns where the box is met, or `missed`,
  /// and calls visit(i), which returns the new limit.
  template <class Meet, class Visit>
  void walk(double limit, const Meet& meet, const Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<Aabb> boxes_;       ///< of the members, in the order of the leaves
  std::vector<uint32_t> ids_;     ///< of the members
  std::vector<uint32_t> beside_;  ///< indices of infinite bounds
  double reach_ = 0;              ///< largest coordinate of the members [m]
};

inline Aabb BoundsTree::bounds() const {
  if (beside_.empty()) return nodes_.empty() ? Aabb() : nodes_[0].box;
  const Vec3 everywhere = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {-everywhere, everywhere};
}

template <class Meet, class Visit>
void BoundsTree::walk(double limit, const Meet& meet, const Visit& visit) const {
  for (const uint32_t i : beside_) {
    limit = visit(i);
    if (!(limit >= 0)) return;
  }
  if (nodes_.empty()) return;
  Waiting waiting;
  const double at_root = meet(nodes_[0].box, limit);
  if (at_root < missed) waiting.push(at_root, 0);
  while (!waiting.empty()) {
    Branch at = waiting.pop();
    if (at.at > limit) continue;
    while (nodes_[at.node].right != 0) {
      Branch near{0, at.node + 1}, far{0, nodes_[at.node].right};
      near.at = meet(nodes_[near.node].box, limit);
      far.at = meet(nodes_[far.node].box, limit);
      if (far.at < near.at) std::swap(near, far);
      at = near;
      if (near.at == missed) break;
      if (far.at < missed) waiting.push(far.at, far.node);
    }
    if (at.at == missed) continue;
    for (uint32_t k = nodes_[at.node].first; k < nodes_[at.node].last; ++k) {
      if (meet(boxes_[k], limit) == missed) continue;
      limit = visit(ids_[k]);
      if (!(limit >= 0)) return;
    }
  }
}

template <class Visit>
void BoundsTree::along(const Ray& ray, const Vec3& half, double t_max, const Visit& visit) const {
  // Upper bound of the rounding errors of the origin, the direction and the boxes.
  const double reach = reach_ + ray.origin.cwiseAbs().maxCoeff() + half.maxCoeff();
  // Adding 0 turns -0 into 0.
  const Sweep sweep{ray.origin, (ray.direction.array() + 0.0).inverse(),
                    half.array() + 1e-14 * reach};
  walk(
      t_max, [&](const Aabb& b, double limit) { return sweep.entry(b, limit); }, visit);
}

template <class Visit>
void BoundsTree::overlapping(const Aabb& box, const Visit& visit) const {
  walk(
      0, [&](const Aabb& b, double) { return b.overlaps(box) ? 0 : missed; },
      [&](uint32_t i) { return visit(i) ? 0.0 : -1.0; });
}

template <class Visit>
void BoundsTree::around(const Vec3& x, double reach, const Visit& visit) const {
  const double pad = 1e-14 * (reach_ + x.cwiseAbs().maxCoeff());
  const auto distance = [&](const Aabb& b, double limit) {
    const Vec3 out = (b.min - x).cwiseMax(x - b.max).array() - pad;
    const double d = std::min(out.cwiseMax(0.0).norm(), std::numeric_limits<double>::max());
    return d <= limit ? d : missed;
  };
  walk(reach, distance, visit);
}

}  // namespace tumble
