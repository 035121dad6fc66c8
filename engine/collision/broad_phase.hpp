#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tumble {

/// What the broad phase knows of a shape: bounds (swept over the tick where asked) and whether it
/// can have moved. Bounds may be infinite.
struct BroadPhaseProxy {
  Aabb bounds;
  bool moving = false;  ///< pairs of two proxies that do not move are not reported
};

/// Indices into the proxies, a < b.
struct ProxyPair {
  uint32_t a = 0, b = 0;
  friend auto operator<=>(const ProxyPair&, const ProxyPair&) = default;
};

struct BroadPhaseStats {
  uint64_t tested = 0;  ///< bounds compared
  uint64_t found = 0;   ///< pairs reported
};

/// Finds all pairs of overlapping bounds of which at least one moves.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// Replaces `pairs` by the sorted list without duplicates: the same for every implementation.
  virtual void find_pairs(std::span<const BroadPhaseProxy> proxies,
                          std::vector<ProxyPair>& pairs) = 0;
  const BroadPhaseStats& stats() const { return stats_; }

 protected:
  BroadPhaseStats stats_;
};

struct BroadPhaseEntry {
  std::string_view name;
  std::unique_ptr<BroadPhase> (*make)();
};

/// "brute_force", "uniform_grid".
const std::vector<BroadPhaseEntry>& all_broad_phases();

}  // namespace tumble
