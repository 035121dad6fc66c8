#include "engine/dynamics/bodies/pair_filter.hpp"

#include <algorithm>

namespace tumble {

void PairFilter::set_groups(std::span<const RigidBody> bodies) {
  groups_.clear();
  if (std::ranges::all_of(bodies, [](const RigidBody& b) { return b.group == 0; })) return;
  groups_.reserve(bodies.size());
  for (const RigidBody& b : bodies) groups_.push_back(b.group);
}

void PairFilter::add(uint32_t a, uint32_t b) {
  pairs_.emplace_back(std::min(a, b), std::max(a, b));
}

void PairFilter::sort() {
  std::sort(pairs_.begin(), pairs_.end());
}

bool PairFilter::excludes(uint32_t a, uint32_t b) const {
  return of_one_group(a, b) || std::binary_search(pairs_.begin(), pairs_.end(),
                                                  std::pair(std::min(a, b), std::max(a, b)));
}

void PairFilter::apply(const ProxySet& proxies, std::vector<ProxyPair>& pairs) const {
  if (pairs_.empty() && groups_.empty()) return;
  std::erase_if(pairs, [&](const ProxyPair& p) {
    return excludes(proxies.refs[p.a].body, proxies.refs[p.b].body);
  });
}

}  // namespace tumble
