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

/// What the broad phase knows of a shape: bounds (swept over the tick where asked) and whether it
/// can have moved. Bounds may be infinite; empty ones (min > max along any axis) overlap nothing.
/// Bounds that touch overlap.
struct BroadPhaseProxy {
  Aabb bounds;
  bool moving = false;  ///< pairs of two proxies that do not move are not reported
};

/// What has changed in a list of proxies since it was last updated, so that those at rest need not
/// be visited.
struct ProxyNews {
  uint64_t number = 0;           ///< one more with every update of the list
  bool all = true;               ///< any proxy may be another than in the update before
  std::vector<uint32_t> moving;  ///< indices of those that move, ascending
  /// Unless all: of those that have come to rest (changed, and do not move), ascending.
  std::vector<uint32_t> settled;

  /// After an update of all proxies.
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
/// what it learned for the next call, which is fastest when most proxies keep their index; the
/// pairs never depend on earlier calls. Give each stage whose bounds differ an object of its own.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// Replaces `pairs` by the sorted list without duplicates: the same for every implementation.
  virtual void find_pairs(std::span<const BroadPhaseProxy> proxies,
                          std::vector<ProxyPair>& pairs) = 0;
  /// The same of a list that says what changed since its update before. What rests is not touched
  /// if little moves and the last call was for that update.
  virtual void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                          std::vector<ProxyPair>& pairs);
  /// Threads for find_pairs() to use, or none; until the next call of this they must live. The
  /// pairs are the same for any number of them.
  void use_threads(Crew* crew) { crew_ = crew; }
  /// By proxy whose it is: pairs of one owner are not reported. None: each is its own. They must
  /// live until the next call of this.
  void set_owners(std::span<const uint32_t> owners) { owners_ = owners; }
  /// Draws the cells or boxes of the last find_pairs(), which had these proxies, a colour for each
  /// level; nothing where there are none.
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
