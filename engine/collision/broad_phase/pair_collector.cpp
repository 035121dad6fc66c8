#include "engine/collision/broad_phase/pair_collector.hpp"

#include <algorithm>

namespace tumble {

void PairCollector::start(std::span<const BroadPhaseProxy> proxies) {
  proxies_ = proxies;
  found_.clear();
  stats_ = {};
}

BroadPhaseStats PairCollector::finish(std::vector<ProxyPair>& pairs) {
  // Into one run per first index, then each run by the second: most runs are a few pairs long.
  ends_.assign(proxies_.size() + 1, 0);
  for (const ProxyPair& p : found_) ++ends_[p.a + 1];
  for (size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
  pairs.resize(found_.size());
  for (const ProxyPair& p : found_) pairs[ends_[p.a]++] = p;
  for (size_t i = 0, first = 0; i < proxies_.size(); first = ends_[i++]) {
    const auto begin = pairs.begin() + std::ptrdiff_t(first);
    const auto end = pairs.begin() + std::ptrdiff_t(ends_[i]);
    if (end - begin > 1)
      std::sort(begin, end, [](const ProxyPair& p, const ProxyPair& q) { return p.b < q.b; });
  }
  stats_.found = pairs.size();
  return stats_;
}

}  // namespace tumble
