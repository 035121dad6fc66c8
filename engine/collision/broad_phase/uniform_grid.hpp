#pragma once
#include "engine/collision/broad_phase/hash_level.hpp"
#include "engine/collision/broad_phase/large_bounds.hpp"

namespace tumble {

/// One hash grid (Coutinho §2.4.1) whose cell is the largest size, at most twice the median.
/// Whatever is larger, infinite bounds among it, is kept in a list of its own, compared with the
/// cells that it covers and with the rest of the list.
class UniformGridBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  double choose_edge(std::span<const BroadPhaseProxy> proxies);

  HashLevel level_;
  LargeBounds large_;
  PairCollector collector_;
  std::vector<double> sizes_, finite_sizes_;
  std::vector<uint32_t> members_;
};

}  // namespace tumble
