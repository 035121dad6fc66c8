#pragma once
#include "engine/core/crew.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tumble {

class DebugDraw;

/// The input of the broad phase for a shape: its bounds (swept over the tick if the caller wants
/// that), and whether it may have moved. Bounds may be infinite; empty ones (min > max along any
/// axis) overlap nothing. Bounds that touch overlap.
struct BroadPhaseProxy {
  Aabb bounds;
  bool moving = false;  ///< pairs of two proxies that do not move are not reported
};

/// What has changed in a list of proxies since it was last updated, so that those at rest need not
/// be visited.
struct ProxyNews {
  uint64_t number = 0;           ///< incremented by every update of the list
  bool all = true;               ///< any proxy may differ from the update before
  std::vector<uint32_t> moving;  ///< indices of those that move, ascending
  /// Unless `all`: indices of those that came to rest (they changed, and no longer move),
  /// ascending.
  std::vector<uint32_t> settled;

  /// To be called after an update of all proxies.
  void everything(std::span<const BroadPhaseProxy> proxies);
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

/// Finds all pairs of overlapping bounds of which at least one moves. An implementation may keep
/// data for the next call, which is fastest when most proxies keep their index; the pairs never
/// depend on earlier calls. Use a separate object for each stage whose bounds differ.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// Replaces `pairs` by the sorted list without duplicates: the same for every implementation.
  virtual void find_pairs(std::span<const BroadPhaseProxy> proxies,
                          std::vector<ProxyPair>& pairs) = 0;
  /// The same for a list with news of its changes. Proxies at rest are not visited if few move and
  /// the last call had the update before this one.
  virtual void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                          std::vector<ProxyPair>& pairs);
  /// Threads for find_pairs() to use, or null; they must live until the next call of this function.
  /// The pairs are the same for any number of threads.
  void use_threads(Crew* crew) { crew_ = crew; }
  /// Owner of each proxy: pairs of the same owner are not reported. Empty: each proxy is its own.
  /// The list must live until the next call of this function.
  void set_owners(std::span<const uint32_t> owners) { owners_ = owners; }
  /// Draws the cells or boxes of the last find_pairs(), which was given these proxies, in a colour
  /// for each level; nothing if the algorithm has none.
  virtual void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const;
  const BroadPhaseStats& stats() const { return stats_; }

 protected:
  BroadPhaseStats stats_;
  Crew* crew_ = nullptr;
  std::span<const uint32_t> owners_;
};

struct BroadPhaseEntry {
  std::string_view name;
  std::unique_ptr<BroadPhase> (*make)();
};

/// "brute_force", "uniform_grid", "multi_level_grid", "aabb_tree".
const std::vector<BroadPhaseEntry>& all_broad_phases();

}  // namespace tumble
