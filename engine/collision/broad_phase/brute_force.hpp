#pragma once
#include "engine/collision/broad_phase.hpp"

namespace tumble {

/// Compares every pair of bounds: the reference for the others.
class BruteForceBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
};

}  // namespace tumble
