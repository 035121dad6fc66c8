#pragma once
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// Two trees of boxes. What rests with unchanged bounds lives in the still tree, which is not
/// touched from call to call; what moves is built anew in every call, which is faster than moving
/// leaves about as soon as many of them move. A leaf whose bounds change, or that is gone, is taken
/// out of the still tree at once; newly resting ones wait among the moving until they are a
/// sixteenth of the still tree, which is then built anew (the logarithmic method of Bentley and
/// Saxe, 1980).
class AabbTreeBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  void follow_still(std::span<const BroadPhaseProxy> proxies);
  void sort_out(std::span<const BroadPhaseProxy> proxies);
  void rebuild_still(std::span<const BroadPhaseProxy> proxies);

  PackedTree still_, moving_;
  Vec3 origin_ = Vec3::Zero();      ///< of the still tree, and so of all
  std::vector<Aabb> still_bounds_;  ///< by position in the still tree
  size_t still_count_ = 0;          ///< not taken out
  std::vector<uint8_t> is_still_;   ///< by proxy: in the still tree
  size_t last_count_ = 0;           ///< of proxies
  std::vector<uint32_t> moving_ids_, resting_ids_;
  LargeBounds large_;
  PairCollector collector_;
};

}  // namespace tumble
