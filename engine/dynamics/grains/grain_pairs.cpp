#include "engine/dynamics/grains/grain_pairs.hpp"

#include "engine/collision/particle_contacts/gather.hpp"
#include "engine/dynamics/grains/pair_kernels.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

struct NoGrainMemory {};

}  // namespace

/// Calls f with the places of the grains whose centres are within `reach`, and what the two may
/// close, of that at place i.
template <class F>
void GrainPairs::near(size_t i, double reach, const F& f) {
  const uint32_t own = list_of_[i];
  const std::span<const uint32_t> list = lists_.of(own);
  std::array<uint32_t, 64> found;
  for (size_t begin = 0; begin < list.size(); begin += found.size()) {
    const auto some = list.subspan(begin, std::min(found.size(), list.size() - begin));
    const size_t count = near_grains(spots_.data(), own, some, reach, found.data());
    for (size_t k = 0; k < count; ++k) {
      const uint32_t j = place_of_[found[k]];
      f(j, (spots_[found[k]].x - spots_[own].x).squaredNorm());
    }
  }
}

void GrainPairs::rouse(const GrainTick& tick, GrainField& grains) {
  if (grains.sleepers == 0 || grains.sleepers == grains.size()) return;
  std::vector<uint32_t> roused;
  gather_found<NoGrainMemory>(
      tick.crew, grains.size(), roused, [&](size_t i, NoGrainMemory&, std::vector<uint32_t>& out) {
        if (grains.asleep[i]) return;
        const double r = grains.points[i].radius;
        const double slow = tolerances::grain_wakes * GrainField::rest_speed(tick, r);
        if (grains.movers[i].v.norm() + r * grains.movers[i].spin.norm() <= slow) return;
        const double farthest = (r + grains.largest_radius) * (1 + tolerances::grain_margin);
        near(i, farthest, [&](uint32_t j, double d2) {
          if (!grains.asleep[j]) return;
          const double reach = (r + grains.points[j].radius) * (1 + tolerances::grain_margin);
          if (d2 <= reach * reach) out.push_back(j);
        });
      });
  for (const uint32_t i : roused) {
    if (!grains.asleep[i]) continue;
    grains.wake(tick, i);
    --grains.sleepers;
  }
}

Status GrainPairs::update_lists(const GrainTick& tick, const GrainField& grains, double h) {
  Vec3 mean = Vec3::Zero();
  for (const GrainMover& m : grains.movers) mean += m.v;
  mean /= double(grains.size());
  double fastest = 0;
  for (const GrainMover& m : grains.movers) fastest = std::max(fastest, (m.v - mean).squaredNorm());
  // Few different reaches, so that lists stay.
  const double closes = 2 * h * std::sqrt(fastest) / grains.largest_radius;
  double level = tolerances::grain_margin + tolerances::grain_foresight;
  while (0.5 * level >= tolerances::grain_margin + closes) level *= 0.5;
  by_ordinal_.resize(grains.size());
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) by_ordinal_[grains.ordinal[i]] = grains.points[i].x;
  });
  const NeighbourLists::Request request{.reach = grains.largest_radius * (2 + level),
                                        .skin = grains.largest_radius * tolerances::grain_skin};
  if (const auto made = lists_.update(by_ordinal_, request, tick.crew); !made) return made.error();
  list_of_.resize(grains.size());
  spots_.resize(lists_.places());
  place_of_.resize(grains.size());
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      place_of_[k] = grains.place_of[lists_.order()[k]];
      list_of_[place_of_[k]] = uint32_t(k);
      spots_[k] = {grains.points[place_of_[k]].x,
                   h * (grains.movers[place_of_[k]].v - mean).norm()};
    }
  });
  spots_.back() = {{lists_.x().back(), lists_.y().back(), lists_.z().back()}, 0};
  return {};
}

void GrainPairs::find_of(const GrainField& grains, double h, size_t i,
                         std::vector<GrainPair>& out) {
  const size_t begin = out.size();
  const double r = grains.points[i].radius;
  const double reach_all = r + grains.largest_radius + r * tolerances::grain_margin;
  near(i, reach_all, [&](uint32_t j, double d2) {
    if (grains.ordinal[j] < grains.ordinal[i] || (grains.asleep[i] && grains.asleep[j])) return;
    const double rj = grains.points[j].radius, least = std::min(r, rj);
    const double closing = (grains.movers[j].v - grains.movers[i].v).norm();
    const double reach = r + rj + least * tolerances::grain_margin +
                         std::min(least * tolerances::grain_foresight, h * closing);
    if (d2 <= reach * reach) out.push_back({uint32_t(i), j});
  });
  std::sort(out.begin() + std::ptrdiff_t(begin), out.end(),
            [&](const GrainPair& u, const GrainPair& v) {
              return grains.ordinal[u.b] < grains.ordinal[v.b];
            });
}

Status GrainPairs::find(const GrainTick& tick, GrainField& grains, double h, GrainPairList& out) {
  if (Status done = update_lists(tick, grains, h); !done) return done;
  rouse(tick, grains);
  found_.resize(chunk_count);
  for (auto& f : found_) f.clear();
  out.first.assign(grains.size() + 1, 0);
  // Where those of each end, first in the chunk and then in all.
  std::array<std::pair<size_t, size_t>, chunk_count> chunks{};
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    chunks[chunk] = {first, last};
    for (size_t i = first; i < last; ++i) {
      find_of(grains, h, i, found_[chunk]);
      out.first[i + 1] = uint32_t(found_[chunk].size());
    }
  });
  std::array<size_t, chunk_count> before{};
  size_t sum = 0;
  for (size_t c = 0; c < chunk_count; ++c) {
    before[c] = sum;
    sum += found_[c].size();
  }
  out.all.resize(sum);
  for_chunks(
      tick.crew, chunk_count,
      [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
          std::ranges::copy(found_[c], out.all.begin() + std::ptrdiff_t(before[c]));
          for (size_t i = chunks[c].first; i < chunks[c].second; ++i)
            out.first[i + 1] += uint32_t(before[c]);
        }
      },
      2);
  return {};
}

}  // namespace tumble
