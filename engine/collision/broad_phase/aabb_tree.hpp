#pragma once
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// Bounding volume trees. Proxies that rest with unchanged bounds are in the still tree, which is
/// not visited between calls; a tree of the moving ones is built in every call, which is faster
/// than moving leaves as soon as many of them move. A leaf whose bounds change, or that is removed,
/// is taken out of the still tree at once. Proxies that have come to rest are first collected in a
/// waiting tree, until they number a sixteenth of the still tree, which is then rebuilt with them
/// (the logarithmic method of Bentley and Saxe, 1980).
class AabbTreeBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                  std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  /// Where a proxy is kept between calls.
  enum class Place : uint8_t { none, still, waiting, large };

  void follow_all(std::span<const BroadPhaseProxy> proxies);
  void follow_still(std::span<const BroadPhaseProxy> proxies);
  void follow_news(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news);
  void take_out(uint32_t id);
  void let_wait(std::span<const BroadPhaseProxy> proxies, uint32_t id);
  void rebuild_still(std::span<const BroadPhaseProxy> proxies);
  void compare(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs);

  PackedTree still_, waiting_, moving_;
  Vec3 origin_ = Vec3::Zero();      ///< for packing, of all trees
  std::vector<Aabb> still_bounds_;  ///< by position in the still tree
  size_t still_count_ = 0;          ///< without those taken out
  std::vector<Place> place_;        ///< by proxy
  std::vector<uint32_t> position_;  ///< by proxy: position in the still tree
  uint64_t last_news_ = 0;          ///< ProxyNews::number; 0 if the last call had none
  /// Waiting and large ones are at rest.
  std::vector<uint32_t> moving_ids_, waiting_ids_, large_ids_;
  bool waiting_changed_ = false;
  LargeBounds large_;
  PairCollector collector_;
};

}  // namespace tumble
