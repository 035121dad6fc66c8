#include "engine/dynamics/grains/grain_memory.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/scratch_size.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tumble {

bool GrainMemory::in_order(const Beside& u, const Beside& v) {
  return u.place != v.place ? u.place < v.place : u.touch.b < v.touch.b;
}

void GrainMemory::find_own(const GrainTick& tick, const GrainField& grains,
                           std::span<const GrainTouch> touches) {
  own_.assign(grains.size(), {});
  for_chunks(tick.crew, touches.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      if (k > 0 && touches[k - 1].a == touches[k].a) continue;
      const size_t i = grains.find(tick.systems, touches[k].a);
      if (i == grains.size()) continue;
      size_t end = k + 1;
      while (end < touches.size() && touches[end].a == touches[k].a) ++end;
      own_[i] = {uint32_t(k), uint32_t(end)};
    }
  });
}

void GrainMemory::recall_pairs(const GrainTick& tick, const GrainField& grains,
                               std::span<const GrainTouch> touches, const GrainPairList& pairs) {
  forces_.resize(pairs.all.size());
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      uint32_t t = own_[i].begin;
      for (uint32_t k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
        const uint64_t b = grains.key[pairs.all[k].b];
        while (t < own_[i].end && touches[t].b < b) ++t;
        const bool found = t < own_[i].end && touches[t].b == b;
        forces_[k] = found ? static_cast<const GrainForces&>(touches[t]) : GrainForces{};
        if (found) taken_[t] = 1;
      }
    }
  });
}

void GrainMemory::recall_row(std::span<const GrainTouch> touches, double hs, GrainBodyRow& row) {
  for (uint32_t t = own_[row.a].end; t > own_[row.a].begin && touches[t - 1].b >= row.key; --t) {
    const GrainTouch& touch = touches[t - 1];
    if (touch.b != row.key) continue;
    taken_[t - 1] = 1;
    const auto impulse = [hs](const std::array<float, 3>& f) {
      return Vec3(hs * Vec3(double(f[0]), double(f[1]), double(f[2])));
    };
    row.push = hs * double(touch.push);
    row.rub = impulse(touch.rub);
    if (row.turn_mass > 0) row.turn = impulse(touch.turn);
  }
}

void GrainMemory::sort_out(const GrainTick& tick, const GrainField& grains, const GrainTouch& t,
                           Left& left) {
  const size_t none = grains.size(), a = grains.find(tick.systems, t.a);
  if (t.on_body()) {
    if (a == none || !grains.asleep[a]) return;
    const bool there =
        t.body() < tick.bodies.bodies.size() && !tick.bodies.bodies[t.body()].shapes.empty();
    if (there)
      left.kept.push_back({uint32_t(a), t});
    else
      left.lost.push_back(uint32_t(a));
    return;
  }
  const size_t b = grains.find(tick.systems, t.b);
  const bool sleeps_a = a != none && grains.asleep[a], sleeps_b = b != none && grains.asleep[b];
  if (sleeps_a && sleeps_b) return left.kept.push_back({uint32_t(a), t});
  if (sleeps_a) left.lost.push_back(uint32_t(a));
  if (sleeps_b) left.lost.push_back(uint32_t(b));
}

void GrainMemory::recall(const GrainTick& tick, const GrainField& grains,
                         const GrainTouches& touches, const GrainPairList& pairs,
                         std::span<GrainBodyRow> walls, std::span<GrainBodyRow> held, double hs) {
  const std::span<const GrainTouch> all = touches.all();
  taken_.assign(all.size(), 0);
  find_own(tick, grains, all);
  recall_pairs(tick, grains, all, pairs);
  for (const std::span<GrainBodyRow> rows : {walls, held})
    for_chunks(tick.crew, rows.size(), [&](size_t, size_t first, size_t last) {
      for (GrainBodyRow& row : rows.subspan(first, last - first)) recall_row(all, hs, row);
    });
  std::array<Left, chunk_count> left;
  for_chunks(tick.crew, all.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k)
      if (!taken_[k]) sort_out(tick, grains, all[k], left[chunk]);
  });
  kept_.clear();
  lost_.clear();
  for (const Left& l : left) {
    kept_.insert(kept_.end(), l.kept.begin(), l.kept.end());
    lost_.insert(lost_.end(), l.lost.begin(), l.lost.end());
  }
}

void GrainMemory::list_beside(const GrainField& grains, std::span<const GrainBodyRow> walls,
                              std::span<const GrainBodyRow> held, double hs, size_t first,
                              size_t last, std::vector<Beside>& out) const {
  const auto in_range = [&](const auto& list, auto place) {
    const auto begin = std::ranges::lower_bound(list, first, {}, place);
    return std::span(begin, std::ranges::lower_bound(begin, list.end(), last, {}, place));
  };
  const auto force = [hs](const Vec3& v) {
    return std::array{float(v[0] / hs), float(v[1] / hs), float(v[2] / hs)};
  };
  const auto kept = in_range(kept_, &Beside::place);
  out.assign(kept.begin(), kept.end());
  for (const std::span<const GrainBodyRow> rows : {walls, held})
    for (const GrainBodyRow& r : in_range(rows, &GrainBodyRow::a))
      if (r.push > 0)
        out.push_back(
            {r.a, {{float(r.push / hs), force(r.rub), force(r.turn), 0}, grains.key[r.a], r.key}});
  if (!std::ranges::is_sorted(out, in_order)) std::ranges::sort(out, in_order);
}

template <class F>
void GrainMemory::each_of(const GrainField& grains, const GrainPairList& pairs,
                          std::span<const Beside> listed, size_t first, size_t last,
                          const F& f) const {
  auto beside = listed.begin();
  for (size_t i = first; i < last; ++i) {
    const auto add_beside = [&](uint64_t end) {
      for (; beside != listed.end() && beside->place == i && beside->touch.b < end; ++beside)
        f(beside->touch);
    };
    for (uint32_t k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
      if (!(forces_[k].push > 0)) continue;
      const uint64_t b = grains.key[pairs.all[k].b];
      add_beside(b);
      f(GrainTouch{forces_[k], grains.key[i], b});
    }
    add_beside(~uint64_t{0});
  }
}

void GrainMemory::store(const GrainTick& tick, const GrainField& grains, const GrainPairList& pairs,
                        std::span<const GrainBodyRow> walls, std::span<const GrainBodyRow> held,
                        double hs, GrainTouches& touches) {
  // Usually sorted already, since sleeping grains do not change places.
  if (!std::ranges::is_sorted(kept_, in_order)) std::ranges::sort(kept_, in_order);
  // First the number of contacts of each thread's range, then the contacts.
  std::array<size_t, chunk_count> begins{};
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    list_beside(grains, walls, held, hs, first, last, beside_[chunk]);
    size_t count = beside_[chunk].size();
    for (uint32_t k = pairs.first[first]; k < pairs.first[last]; ++k) count += forces_[k].push > 0;
    begins[chunk] = count;
  });
  size_t sum = 0;
  for (size_t& b : begins) sum += std::exchange(b, sum);
  resize_scratch(next_, sum);
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    GrainTouch* to = next_.data() + begins[chunk];
    each_of(grains, pairs, beside_[chunk], first, last, [&](const GrainTouch& t) { *to++ = t; });
  });
  touches.replace(next_, grains.size());
}

}  // namespace tumble
