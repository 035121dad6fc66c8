#include "engine/collision/broad_phase/uniform_grid.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Cells are numbered -limit .. limit along each axis; whatever is farther out shares the last.
constexpr int32_t limit = (1 << 20) - 1;
/// Proxies that would enter more cells than this are compared with everything instead.
constexpr int64_t max_cells = 64;

}  // namespace

void UniformGridBroadPhase::choose_cell_size(std::span<const BroadPhaseProxy> proxies) {
  sizes_.clear();
  for (const BroadPhaseProxy& p : proxies) {
    const double size = p.bounds.extent().maxCoeff();
    if (p.moving && std::isfinite(size) && size > 0) sizes_.push_back(size);
  }
  cell_ = 1;
  if (sizes_.empty()) return;
  const auto middle = sizes_.begin() + std::ptrdiff_t(sizes_.size() / 2);
  std::nth_element(sizes_.begin(), middle, sizes_.end());
  cell_ = std::max(1.5 * *middle, 1e-9);
}

UniformGridBroadPhase::Cell UniformGridBroadPhase::cell_of(const Vec3& x) const {
  Cell c;
  for (int k = 0; k < 3; ++k)
    c[size_t(k)] = int32_t(std::clamp(std::floor(x[k] / cell_), double(-limit), double(limit)));
  return c;
}

uint64_t UniformGridBroadPhase::pack(const Cell& c) {
  return (uint64_t(c[0] + limit) << 42) | (uint64_t(c[1] + limit) << 21) | uint64_t(c[2] + limit);
}

void UniformGridBroadPhase::enter(std::span<const BroadPhaseProxy> proxies) {
  entries_.clear();
  large_.clear();
  is_large_.assign(proxies.size(), 0);
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    const Aabb& b = proxies[i].bounds;
    if (b.empty()) continue;
    bool finite = b.min.allFinite() && b.max.allFinite();
    Cell lo{}, hi{};
    int64_t count = 1;
    if (finite) {
      lo = cell_of(b.min);
      hi = cell_of(b.max);
      for (size_t k = 0; k < 3; ++k) count = std::min(count * (hi[k] - lo[k] + 1), 2 * max_cells);
    }
    if (!finite || count > max_cells) {
      large_.push_back(i);
      is_large_[i] = 1;
      continue;
    }
    for (int32_t x = lo[0]; x <= hi[0]; ++x)
      for (int32_t y = lo[1]; y <= hi[1]; ++y)
        for (int32_t z = lo[2]; z <= hi[2]; ++z) entries_.push_back({pack({x, y, z}), i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.proxy < b.proxy;
  });
}

void UniformGridBroadPhase::compare_cells(std::span<const BroadPhaseProxy> proxies,
                                          std::vector<ProxyPair>& pairs) {
  for (size_t first = 0; first < entries_.size();) {
    size_t last = first + 1;
    while (last < entries_.size() && entries_[last].cell == entries_[first].cell) ++last;
    for (size_t i = first; i < last; ++i) {
      const BroadPhaseProxy& p = proxies[entries_[i].proxy];
      for (size_t j = i + 1; j < last; ++j) {
        const BroadPhaseProxy& q = proxies[entries_[j].proxy];
        if (!p.moving && !q.moving) continue;
        ++stats_.tested;
        if (!p.bounds.overlaps(q.bounds)) continue;
        // Two bounds share many cells; the one that holds the lower corner of their common box
        // reports them.
        if (pack(cell_of(p.bounds.min.cwiseMax(q.bounds.min))) != entries_[i].cell) continue;
        pairs.push_back({entries_[i].proxy, entries_[j].proxy});
      }
    }
    first = last;
  }
}

void UniformGridBroadPhase::compare_large(std::span<const BroadPhaseProxy> proxies,
                                          std::vector<ProxyPair>& pairs) {
  for (uint32_t l : large_) {
    for (uint32_t i = 0; i < proxies.size(); ++i) {
      if (i == l || (is_large_[i] && i < l)) continue;
      if (!proxies[i].moving && !proxies[l].moving) continue;
      ++stats_.tested;
      if (!proxies[i].bounds.overlaps(proxies[l].bounds)) continue;
      pairs.push_back({std::min(i, l), std::max(i, l)});
    }
  }
}

void UniformGridBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                       std::vector<ProxyPair>& pairs) {
  pairs.clear();
  stats_ = {};
  choose_cell_size(proxies);
  enter(proxies);
  compare_cells(proxies, pairs);
  compare_large(proxies, pairs);
  std::sort(pairs.begin(), pairs.end());
  stats_.found = pairs.size();
}

}  // namespace tumble
