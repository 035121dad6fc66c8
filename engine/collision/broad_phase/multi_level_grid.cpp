#include "engine/collision/broad_phase/multi_level_grid.hpp"

#include "engine/collision/broad_phase/draw_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// With fewer bounds than this a level is slower than comparing them one by one.
constexpr size_t least_members = 8;
/// A finer octave is merged into a coarser one with this many times its members: it would gain
/// little from smaller cells, and cost one more level to look into.
constexpr size_t outnumbered = 4;
/// With more lookups in coarser levels per member than this, on average, the nested cells are used
/// as a tree.
constexpr size_t most_lookups = 1;

/// Octave of a size relative to the largest; octave 0 is (1/2, 1].
uint8_t octave_of(double relative) {
  const double ratio = std::min(relative, 1.0);
  const int finer = ratio > 0 ? -std::ilogb(ratio) : int(MultiLevelGridBroadPhase::octaves);
  const int octave = std::ldexp(ratio, finer) == 1 ? finer : finer - 1;
  return uint8_t(std::clamp(octave, 0, int(MultiLevelGridBroadPhase::octaves) - 1));
}

}  // namespace

void MultiLevelGridBroadPhase::sort_by_size(std::span<const BroadPhaseProxy> proxies) {
  large_.clear();
  for (Octave& o : octaves_) o = {std::move(o.members), 0};
  for (Octave& o : octaves_) o.members.clear();
  sizes_.resize(proxies.size());
  octave_of_.resize(proxies.size());
  std::array<double, chunk_count> largest_of{};
  for_chunks(crew_, proxies.size(), [&](size_t chunk, size_t first, size_t last) {
    double largest = 0;
    for (size_t i = first; i < last; ++i) {
      sizes_[i] = can_be_placed(proxies[i].bounds) ? grid_size(proxies[i].bounds) : -1;
      largest = std::max(largest, sizes_[i]);
    }
    largest_of[chunk] = largest;
  });
  const double largest = *std::max_element(largest_of.begin(), largest_of.end());
  const double scale = 1 / std::max(largest, 1e-200);
  for_chunks(crew_, proxies.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) octave_of_[i] = octave_of(sizes_[i] * scale);
  });
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    if (proxies[i].bounds.empty()) continue;
    if (sizes_[i] < 0) {
      large_.add(proxies[i], i, origin_);
      continue;
    }
    Octave& o = octaves_[octave_of_[i]];
    o.members.push_back(i);
    o.edge = std::max(o.edge, sizes_[i]);
  }
}

void MultiLevelGridBroadPhase::join_octaves(std::span<const BroadPhaseProxy> proxies) {
  for (size_t k = 0; k < octaves; ++k) {
    Octave& o = octaves_[k];
    // Only the next octave is merged, so that no cell has far smaller bounds.
    if (k + 1 < octaves && octaves_[k + 1].members.size() * outnumbered <= o.members.size()) {
      Octave& finer = octaves_[k + 1];
      o.members.insert(o.members.end(), finer.members.begin(), finer.members.end());
      finer.members.clear();
    }
    if (o.members.size() >= least_members) continue;
    for (const uint32_t m : o.members) large_.add(proxies[m], m, origin_);
    o.members.clear();
  }
}

bool MultiLevelGridBroadPhase::many_lookups() const {
  size_t levels = 0, lookups = 0, members = 0;
  for (const Octave& o : octaves_) {
    if (o.members.empty()) continue;
    lookups += o.members.size() * levels++;
    members += o.members.size();
  }
  return lookups > most_lookups * members;
}

void MultiLevelGridBroadPhase::build_levels(std::span<const BroadPhaseProxy> proxies) {
  for (const Octave& o : octaves_) {
    if (o.members.empty()) continue;
    if (levels_.size() == level_count_) levels_.emplace_back();
    levels_[level_count_++].build(proxies, o.members, o.edge, origin_, crew_);
  }
}

void MultiLevelGridBroadPhase::compare_nested(std::span<const BroadPhaseProxy> proxies) {
  nested_ids_.clear();
  for (const Octave& o : octaves_)
    nested_ids_.insert(nested_ids_.end(), o.members.begin(), o.members.end());
  nested_.build(proxies, nested_ids_, origin_, crew_);
  nested_.pairs_within(collector_, crew_);
  for (size_t i = 0; i < large_.set().size(); ++i)
    nested_.pairs_with(large_.set().bounds[i], large_.set().ids[i], collector_);
}

void MultiLevelGridBroadPhase::compare_levels(std::span<const BroadPhaseProxy> proxies) {
  for (size_t fine = 0; fine < level_count_; ++fine) {
    levels_[fine].pairs_within(collector_, crew_);
    large_.pairs_with(levels_[fine].members(), collector_);
    const PackedSet& set = levels_[fine].members();
    for (size_t coarse = 0; coarse < fine; ++coarse)
      for (size_t i = 0; i < set.size(); ++i)
        levels_[coarse].pairs_with(proxies[set.ids[i]].bounds, set.bounds[i], set.ids[i],
                                   collector_);
  }
}

void MultiLevelGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                          std::vector<ProxyPair>& pairs) {
  few_moving_.skip();
  collector_.start(proxies, owners_);
  origin_ = packing_origin(proxies);
  sort_by_size(proxies);
  join_octaves(proxies);
  level_count_ = 0;
  if (many_lookups()) {
    compare_nested(proxies);
  } else {
    build_levels(proxies);
    compare_levels(proxies);
  }
  large_.pairs_within(collector_);
  stats_ = collector_.finish(pairs, crew_);
}

void MultiLevelGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                          const ProxyNews& news, std::vector<ProxyPair>& pairs) {
  if (few_moving_.takes(proxies.size(), news))
    stats_ = few_moving_.find_pairs(proxies, owners_, news, crew_, pairs);
  else
    find_pairs(proxies, pairs);
}

void MultiLevelGridBroadPhase::draw(std::span<const BroadPhaseProxy> proxies,
                                    DebugDraw& out) const {
  if (few_moving_.took()) return few_moving_.draw(proxies, out);
  for (size_t k = 0; k < octaves; ++k)
    draw_cells(proxies, octaves_[k].members, octaves_[k].edge, level_colour(k), out);
}

}  // namespace tumble
