#include "engine/collision/broad_phase/uniform_grid.hpp"

#include "engine/collision/broad_phase/draw_cells.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace tumble {

namespace {

/// More large bounds than this go into a tree.
constexpr size_t most_listed = 32;
/// The median is estimated from about so many sizes.
constexpr size_t median_sample = 1024;

}  // namespace

double UniformGridBroadPhase::measure(std::span<const BroadPhaseProxy> proxies) {
  sizes_.resize(proxies.size());
  std::array<Aabb, chunk_count> boxes;
  for_chunks(crew_, proxies.size(), [&](size_t chunk, size_t first, size_t last) {
    Aabb box;
    for (size_t i = first; i < last; ++i) {
      const Aabb& b = proxies[i].bounds;
      const bool placed = can_be_placed(b);
      sizes_[i] = placed ? grid_size(b) : std::numeric_limits<double>::infinity();
      if (placed) box.include(b);
    }
    boxes[chunk] = box;
  });
  Aabb all;
  for (const Aabb& box : boxes)
    if (!box.empty()) all.include(box);
  origin_ = all.empty() ? Vec3::Zero() : Vec3(0.5 * all.min + 0.5 * all.max);
  finite_sizes_.clear();
  const size_t stride = 1 + proxies.size() / median_sample;
  size_t phase = 0, finite = 0;
  for (const double size : sizes_) {
    if (size == std::numeric_limits<double>::infinity()) continue;
    // One size of each stride, at a varying position, so that periodic patterns of sizes do not
    // bias it.
    if (finite++ % stride == phase) finite_sizes_.push_back(size);
    if (finite % stride == 0) phase = (phase * 5 + 3) % stride;
  }
  if (finite_sizes_.empty()) return 0;
  const auto middle = finite_sizes_.begin() + std::ptrdiff_t(finite_sizes_.size() / 2);
  std::nth_element(finite_sizes_.begin(), middle, finite_sizes_.end());
  const double most = 2 * *middle;
  double edge = 0;
  for (const double size : sizes_)
    if (size <= most) edge = std::max(edge, size);
  return edge;
}

void UniformGridBroadPhase::compare_large(std::span<const BroadPhaseProxy> proxies) {
  const bool many = large_ids_.size() > most_listed;
  if (many) {
    large_tree_.build(proxies, large_ids_, origin_, crew_);
    large_tree_.pairs_within(collector_, crew_);
    const PackedSet& small = level_.members();
    for (size_t i = 0; i < small.size(); ++i)
      large_tree_.pairs_with(small.bounds[i], small.ids[i], collector_);
    for (size_t i = 0; i < large_.set().size(); ++i)
      large_tree_.pairs_with(large_.set().bounds[i], large_.set().ids[i], collector_);
  } else {
    for (const uint32_t id : large_ids_) large_.add(proxies[id], id, origin_);
  }
  for (size_t i = 0; i < large_.set().size(); ++i) {
    const uint32_t id = large_.set().ids[i];
    level_.pairs_with(proxies[id].bounds, large_.set().bounds[i], id, collector_);
  }
  large_.pairs_within(collector_);
}

void UniformGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                       std::vector<ProxyPair>& pairs) {
  few_moving_.skip();
  const double edge = measure(proxies);
  collector_.start(proxies, owners_);
  members_.clear();
  large_.clear();
  large_ids_.clear();
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    if (proxies[i].bounds.empty()) continue;
    if (sizes_[i] <= edge)
      members_.push_back(i);
    else if (can_be_placed(proxies[i].bounds))
      large_ids_.push_back(i);
    else
      large_.add(proxies[i], i, origin_);
  }
  level_.build(proxies, members_, edge, origin_, crew_);
  level_.pairs_within(collector_, crew_);
  compare_large(proxies);
  stats_ = collector_.finish(pairs, crew_);
}

void UniformGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                       const ProxyNews& news, std::vector<ProxyPair>& pairs) {
  if (few_moving_.takes(proxies.size(), news))
    stats_ = few_moving_.find_pairs(proxies, owners_, news, crew_, pairs);
  else
    find_pairs(proxies, pairs);
}

void UniformGridBroadPhase::draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const {
  if (few_moving_.took()) return few_moving_.draw(proxies, out);
  draw_cells(proxies, members_, level_.edge(), level_colour(0), out);
}

}  // namespace tumble
