#pragma once
#include "engine/collision/broad_phase/pair_collector.hpp"
#include "engine/core/stop.hpp"

namespace tumble {

/// Whether bounds can be entered in a grid or tree: not empty, and within 10^30 m, so that sums and
/// differences stay finite.
inline bool can_be_placed(const Aabb& b) {
  constexpr double end = 1e30;
  return !b.empty() && (b.min.array() >= -end).all() && (b.max.array() <= end).all();
}

/// A short list of bounds that are not entered in a grid or tree, as they are infinite or far
/// larger than the rest. They are compared one by one.
class LargeBounds {
 public:
  void clear() { set_.resize(0); }
  void add(const BroadPhaseProxy& p, uint32_t id, const Vec3& origin) {
    set_.bounds.push_back(pack(p, origin));
    set_.ids.push_back(id);
  }
  const PackedSet& set() const { return set_; }
  /// Every pair of two in the list.
  void pairs_within(PairCollector& out) const {
    for (size_t i = 0; i < set_.size() && !stop_requested(); ++i)
      out.test(set_.bounds[i], set_.ids[i], set_, i + 1, set_.size());
  }
  /// Every pair of one in the list and one of `others`.
  void pairs_with(const PackedSet& others, PairCollector& out) const {
    for (size_t i = 0; i < set_.size() && !stop_requested(); ++i)
      out.test(set_.bounds[i], set_.ids[i], others, 0, others.size());
  }

 private:
  PackedSet set_;
};

/// Centre of the bounds that can be placed: relative to it, packing in single precision loses
/// least.
inline Vec3 packing_origin(std::span<const BroadPhaseProxy> proxies) {
  Aabb all;
  for (const BroadPhaseProxy& p : proxies)
    if (can_be_placed(p.bounds)) all.include(p.bounds);
  return all.empty() ? Vec3::Zero() : Vec3(0.5 * all.min + 0.5 * all.max);
}

}  // namespace tumble
