#include "engine/collision/broad_phase/uniform_grid.hpp"

#include "engine/collision/broad_phase/draw_cells.hpp"

#include <algorithm>
#include <limits>

namespace tumble {

double UniformGridBroadPhase::choose_edge(std::span<const BroadPhaseProxy> proxies) {
  sizes_.resize(proxies.size());
  finite_sizes_.clear();
  for (size_t i = 0; i < proxies.size(); ++i) {
    const bool placed = can_be_placed(proxies[i].bounds);
    sizes_[i] = placed ? grid_size(proxies[i].bounds) : std::numeric_limits<double>::infinity();
    if (placed) finite_sizes_.push_back(sizes_[i]);
  }
  if (finite_sizes_.empty()) return 0;
  const auto middle = finite_sizes_.begin() + std::ptrdiff_t(finite_sizes_.size() / 2);
  std::nth_element(finite_sizes_.begin(), middle, finite_sizes_.end());
  return std::min(2 * *middle, *std::max_element(middle, finite_sizes_.end()));
}

void UniformGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                       std::vector<ProxyPair>& pairs) {
  const double edge = choose_edge(proxies);
  const Vec3 origin = packing_origin(proxies);
  collector_.start(proxies);
  members_.clear();
  large_.clear();
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    if (proxies[i].bounds.empty()) continue;
    if (sizes_[i] <= edge)
      members_.push_back(i);
    else
      large_.add(proxies[i], i, origin);
  }
  level_.build(proxies, members_, edge, origin);
  level_.pairs_within(collector_);
  for (size_t i = 0; i < large_.set().size(); ++i) {
    const uint32_t id = large_.set().ids[i];
    level_.pairs_with(proxies[id].bounds, large_.set().bounds[i], id, collector_);
  }
  large_.pairs_within(collector_);
  stats_ = collector_.finish(pairs);
}

void UniformGridBroadPhase::draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const {
  draw_cells(proxies, members_, level_.edge(), level_colour(0), out);
}

}  // namespace tumble
