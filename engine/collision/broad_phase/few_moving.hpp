#pragma once
#include "engine/collision/broad_phase/aabb_tree.hpp"

namespace tumble {

/// Used by grids, which enter all bounds anew in every call: lists of which few proxies move are
/// left to trees.
class FewMoving {
 public:
  /// Whether the trees are to find the pairs of this call; took() then tells that they did, until
  /// the next call or skip().
  bool takes(size_t proxies, const ProxyNews& news) {
    took_ = proxies >= least && news.moving.size() < proxies / 4;
    return took_;
  }
  void skip() { took_ = false; }
  bool took() const { return took_; }
  BroadPhaseStats find_pairs(std::span<const BroadPhaseProxy> proxies,
                             std::span<const uint32_t> owners, const ProxyNews& news, Crew* crew,
                             std::vector<ProxyPair>& pairs) {
    trees_.use_threads(crew);
    trees_.set_owners(owners);
    trees_.find_pairs(proxies, news, pairs);
    return trees_.stats();
  }
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const {
    trees_.draw(proxies, out);
  }

 private:
  /// For fewer, the grid is as fast.
  static constexpr size_t least = 256;

  AabbTreeBroadPhase trees_;
  bool took_ = false;
};

}  // namespace tumble
