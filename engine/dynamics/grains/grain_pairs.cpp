#include "engine/dynamics/grains/grain_pairs.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Least number of cells for which threads are worth their cost.
constexpr size_t least_cells = 16;

}  // namespace

Status GrainPairs::sort(const GrainTick& tick, const GrainField& grains, double h) {
  std::array<Vec3, chunk_count> sums;
  sums.fill(Vec3::Zero());
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) sums[chunk] += grains.movers[i].v;
  });
  Vec3 mean = Vec3::Zero();
  for (const Vec3& sum : sums) mean += sum / double(grains.size());
  ways_.resize(grains.size());
  std::array<double, chunk_count> farthest{};
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      ways_[i] = h * (grains.movers[i].v - mean);
      farthest[chunk] = std::max(farthest[chunk], ways_[i].norm());
    }
  });
  const double r = grains.largest_radius, margin = tolerances::grain_margin;
  const double closing = std::min(2 * std::ranges::max(farthest), tolerances::grain_foresight * r);
  return cells_.sort(grains, ways_, 2 * r + std::max(margin * r + closing, 2 * margin * r),
                     tick.crew);
}

template <class Wants, class F>
void GrainPairs::each_cell(Crew* crew, const Wants& wants, const F& f) {
  searches_.resize(chunk_count);
  const auto cells = cells_.cells();
  for_chunks(
      crew, cells.size(),
      [&](size_t chunk, size_t first, size_t last) {
        Search& search = searches_[chunk];
        if (first == last) return;
        search.first = cells[first].first;
        search.last = cells[last - 1].end;
        for (size_t c = first; c < last && !stop_requested(); ++c) {
          if (!wants(c)) continue;
          search.near.collect(cells_, cells[c]);
          f(search, cells[c]);
        }
      },
      least_cells);
}

void GrainPairs::rouse(const GrainTick& tick, GrainField& grains) {
  if (grains.sleepers == 0 || grains.sleepers == grains.size()) return;
  for (Search& s : searches_) s.roused.clear();
  const auto wakes = [&](uint32_t i) {
    if (grains.asleep[i]) return false;
    const double r = grains.points[i].radius;
    const double slow = tolerances::grain_wakes * GrainField::rest_speed(tick, r);
    return grains.movers[i].v.norm() + r * grains.movers[i].spin.norm() > slow;
  };
  const auto some_wakes = [&](size_t c) {
    const CellOrder::Cell& cell = cells_.cells()[c];
    for (uint32_t k = cell.first; k < cell.end; ++k)
      if (wakes(cells_.place(k))) return true;
    return false;
  };
  each_cell(tick.crew, some_wakes, [&](Search& search, const CellOrder::Cell& cell) {
    for (uint32_t k = cell.first; k < cell.end; ++k) {
      const uint32_t i = cells_.place(k);
      if (!wakes(i)) continue;
      const double r = grains.points[i].radius;
      const double more = (r + grains.largest_radius) * tolerances::grain_margin;
      for (const uint32_t n : search.near.of(cells_, k, more, -1)) {
        const uint32_t j = search.near.place(n);
        if (!grains.asleep[j]) continue;
        const double reach = (r + grains.points[j].radius) * (1 + tolerances::grain_margin);
        if ((grains.points[j].x - grains.points[i].x).squaredNorm() <= reach * reach)
          search.roused.push_back(j);
      }
    }
  });
  for (const Search& s : searches_)
    for (const uint32_t i : s.roused) {
      if (!grains.asleep[i]) continue;
      grains.wake(tick, i);
      --grains.sleepers;
    }
}

/// Whether their relative motion could close the gap of two grains in h seconds.
bool GrainPairs::may_meet(const GrainField& grains, uint32_t i, uint32_t j, double h) {
  const GrainPoint &a = grains.points[i], &b = grains.points[j];
  const double least = std::min(a.radius, b.radius);
  const double closing = h * (grains.movers[j].v - grains.movers[i].v).norm();
  const double reach = a.radius + b.radius + least * tolerances::grain_margin +
                       std::min(least * tolerances::grain_foresight, closing);
  return (b.x - a.x).squaredNorm() <= reach * reach;
}

/// Finds the pairs in which the k-th grain, in the order of cells, has the lower key.
void GrainPairs::find_of(const GrainField& grains, double h, uint32_t k, Search& search) {
  const uint32_t i = cells_.place(k);
  search.partners.clear();
  for (const uint32_t n : search.near.of(cells_, k, 0, int32_t(grains.ordinal[i]))) {
    const uint32_t j = search.near.place(n);
    if (grains.asleep[i] && grains.asleep[j]) continue;
    if ((n & doubtful_grain) != 0 && !may_meet(grains, i, j, h)) continue;
    search.partners.push_back(uint64_t(search.near.ordinal(n)) << 32 | j);
  }
  std::ranges::sort(search.partners);
  for (const uint64_t partner : search.partners) search.found.push_back({i, uint32_t(partner)});
  counts_[i] = uint32_t(search.partners.size());
}

Status GrainPairs::find(const GrainTick& tick, GrainField& grains, double h, GrainPairList& out) {
  if (Status done = sort(tick, grains, h); !done) return done;
  rouse(tick, grains);
  cells_.find_awake(grains, tick.crew);
  for (Search& s : searches_) {
    s.found.clear();
    s.first = s.last = 0;
  }
  counts_.assign(grains.size(), 0);
  const auto stirs = [this](size_t c) { return cells_.stirs(c); };
  each_cell(tick.crew, stirs, [&](Search& search, const CellOrder::Cell& cell) {
    for (uint32_t k = cell.first; k < cell.end; ++k) find_of(grains, h, k, search);
  });
  out.first.resize(grains.size() + 1);
  out.first[0] = 0;
  for (size_t i = 0; i < grains.size(); ++i) out.first[i + 1] = out.first[i] + counts_[i];
  out.all.resize(out.first.back());
  for_chunks(
      tick.crew, searches_.size(),
      [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
          auto from = searches_[c].found.begin();
          for (uint32_t k = searches_[c].first; k < searches_[c].last; ++k) {
            const uint32_t i = cells_.place(k);
            std::copy_n(from, counts_[i], out.all.begin() + std::ptrdiff_t(out.first[i]));
            from += std::ptrdiff_t(counts_[i]);
          }
        }
      },
      2);
  return {};
}

}  // namespace tumble
