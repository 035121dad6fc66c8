#pragma once
#include "engine/collision/broad_phase/few_moving.hpp"
#include "engine/collision/broad_phase/hash_level.hpp"
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// One hash grid (Coutinho §2.4.1) whose cells have the largest size that is at most twice the
/// median. Larger bounds are compared with the cells that they cover, and with each other one by
/// one, or, if they are many, by a tree. Infinite bounds are compared with all.
class UniformGridBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                  std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  /// Computes sizes and the packing origin; returns the edge of a cell [m].
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
