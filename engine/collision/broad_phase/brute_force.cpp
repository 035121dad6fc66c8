#include "engine/collision/broad_phase/brute_force.hpp"

#include "engine/core/stop.hpp"

namespace tumble {

void BruteForceBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                      std::vector<ProxyPair>& pairs) {
  pairs.clear();
  stats_ = {};
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    if (stop_requested()) break;
    if (proxies[i].bounds.empty()) continue;
    for (uint32_t j = i + 1; j < proxies.size(); ++j) {
      if (!proxies[i].moving && !proxies[j].moving) continue;
      if (!owners_.empty() && owners_[i] == owners_[j]) continue;
      ++stats_.tested;
      if (!proxies[j].bounds.empty() && proxies[i].bounds.overlaps(proxies[j].bounds))
        pairs.push_back({i, j});
    }
  }
  stats_.found = pairs.size();
}

}  // namespace tumble
