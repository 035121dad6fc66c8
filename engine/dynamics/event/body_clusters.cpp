#include "engine/dynamics/event/body_clusters.hpp"

namespace tumble {

void BodyClusters::reset(size_t bodies) {
  sets_.reset(bodies);
  counts_.assign(bodies, {});
}

void BodyClusters::tie(uint32_t a, uint32_t b) {
  a = sets_.root(a), b = sets_.root(b);
  if (a == b) return;
  const size_t all = counts_[a].bodies + counts_[b].bodies;
  sets_.join(a, b);
  counts_[std::min(a, b)] = {all, all};
}

void BodyClusters::meet(uint32_t a, uint32_t b) {
  a = sets_.root(a), b = sets_.root(b);
  if (a == b) return;
  const Count met{counts_[a].bodies + counts_[b].bodies,
                  std::max(counts_[a].tied, counts_[b].tied)};
  sets_.join(a, b);
  counts_[std::min(a, b)] = met;
}

}  // namespace tumble
