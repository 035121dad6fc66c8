#pragma once
#include "engine/collision/broad_phase/few_moving.hpp"
#include "engine/collision/broad_phase/hash_level.hpp"
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// One hash grid (Coutinho §2.4.1) whose cell is the largest size, at most twice the median.
/// What is larger is compared with the cells that it covers and one by one with its like, or where
/// there is much of it put into a tree. Infinite bounds are compared with all.
class UniformGridBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                  std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  /// Sizes, the origin for packing, and the edge of a cell [m].
  double measure(std::span<const BroadPhaseProxy> proxies);
  void compare_large(std::span<const BroadPhaseProxy> proxies);

  HashLevel level_;
  LargeBounds large_;
  PackedTree large_tree_;  ///< where they are many
  PairCollector collector_;
  FewMoving few_moving_;
  Vec3 origin_ = Vec3::Zero();
  std::vector<double> sizes_, finite_sizes_;
  std::vector<uint32_t> members_, large_ids_;
};

}  // namespace tumble
