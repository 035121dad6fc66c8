#pragma once
#include "engine/collision/broad_phase/aabb_tree.hpp"

namespace tumble {

/// What a grid, which enters all bounds anew in every call, leaves to trees: lists of which little
/// moves.
class FewMoving {
 public:
  /// Whether the trees are to find the pairs of this call; until the next, or skip(), they did.
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
  static constexpr size_t least = 256;  ///< fewer are entered as fast

  AabbTreeBroadPhase trees_;
  bool took_ = false;
};

}  // namespace tumble
