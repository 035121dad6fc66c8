#include "engine/collision/broad_phase.hpp"

#include "engine/collision/broad_phase/aabb_tree.hpp"
#include "engine/collision/broad_phase/brute_force.hpp"
#include "engine/collision/broad_phase/multi_level_grid.hpp"
#include "engine/collision/broad_phase/uniform_grid.hpp"

namespace tumble {

void ProxyNews::everything(std::span<const BroadPhaseProxy> proxies) {
  ++number;
  all = true;
  moving.clear();
  settled.clear();
  for (uint32_t i = 0; i < proxies.size(); ++i)
    if (proxies[i].moving) moving.push_back(i);
}

void BroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews&,
                            std::vector<ProxyPair>& pairs) {
  find_pairs(proxies, pairs);
}

void BroadPhase::draw(std::span<const BroadPhaseProxy>, DebugDraw&) const {}

const std::vector<BroadPhaseEntry>& all_broad_phases() {
  using Made = std::unique_ptr<BroadPhase>;
  static const std::vector<BroadPhaseEntry> list{
      {"brute_force", []() -> Made { return std::make_unique<BruteForceBroadPhase>(); }},
      {"uniform_grid", []() -> Made { return std::make_unique<UniformGridBroadPhase>(); }},
      {"multi_level_grid", []() -> Made { return std::make_unique<MultiLevelGridBroadPhase>(); }},
      {"aabb_tree", []() -> Made { return std::make_unique<AabbTreeBroadPhase>(); }},
  };
  return list;
}

}  // namespace tumble
