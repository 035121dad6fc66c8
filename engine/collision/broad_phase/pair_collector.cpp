#include "engine/collision/broad_phase/pair_collector.hpp"

#include <algorithm>

namespace tumble {

void PairCollector::start(std::span<const BroadPhaseProxy> proxies,
                          std::span<const uint32_t> owners) {
  proxies_ = proxies;
  owners_ = owners;
  found_.clear();
  for (PairCollector& part : parts_) part.start(proxies, owners);
  stats_ = {};
}

BroadPhaseStats PairCollector::finish(std::vector<ProxyPair>& pairs, Crew* crew) {
  for (const PairCollector& part : parts_) stats_.tested += part.stats_.tested;
  const auto for_all = [this](const auto& f) {
    for (const ProxyPair& p : found_) f(p);
    for (const PairCollector& part : parts_)
      for (const ProxyPair& p : part.found_) f(p);
  };
  size_t found = found_.size();
  for (const PairCollector& part : parts_) found += part.found_.size();
  if (found < proxies_.size() / 16) {
    pairs.clear();
    for_all([&](const ProxyPair& p) { pairs.push_back(p); });
    std::sort(pairs.begin(), pairs.end());
    stats_.found = pairs.size();
    return stats_;
  }
  // Sorts into one run per first index, then each run by the second index: most runs are short.
  ends_.assign(proxies_.size() + 1, 0);
  for_all([&](const ProxyPair& p) { ++ends_[p.a + 1]; });
  for (size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
  pairs.resize(ends_.back());
  for_all([&](const ProxyPair& p) { pairs[ends_[p.a]++] = p; });
  for_chunks(crew, proxies_.size(), [&](size_t, size_t from, size_t to) {
    size_t first = from > 0 ? ends_[from - 1] : 0;
    for (size_t i = from; i < to; first = ends_[i++]) {
      const auto begin = pairs.begin() + std::ptrdiff_t(first);
      const auto end = pairs.begin() + std::ptrdiff_t(ends_[i]);
      if (end - begin > 1)
        std::sort(begin, end, [](const ProxyPair& p, const ProxyPair& q) { return p.b < q.b; });
    }
  });
  stats_.found = pairs.size();
  return stats_;
}

}  // namespace tumble
