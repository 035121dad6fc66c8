#include "engine/dynamics/grains/grain_memory.hpp"

#include "engine/core/chunks.hpp"

#include <algorithm>
#include <array>

namespace tumble {

void GrainMemory::find_own(const GrainTick& tick, const GrainField& grains,
                           std::span<const GrainTouch> touches) {
  own_.assign(grains.size(), {});
  const auto place = [&](size_t k) { return grains.find(tick.systems, touches[k].a); };
  for_chunks(tick.crew, touches.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const bool begins = k == 0 || touches[k - 1].a != touches[k].a;
      const bool ends = k + 1 == touches.size() || touches[k + 1].a != touches[k].a;
      if (!begins && !ends) continue;
      const size_t i = place(k);
      if (i == grains.size()) continue;
      if (begins) own_[i].begin = uint32_t(k);
      if (ends) own_[i].end = uint32_t(k + 1);
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
      left.kept.push_back(t);
    else
      left.lost.push_back(uint32_t(a));
    return;
  }
  const size_t b = grains.find(tick.systems, t.b);
  const bool sleeps_a = a != none && grains.asleep[a], sleeps_b = b != none && grains.asleep[b];
  if (sleeps_a && sleeps_b) return left.kept.push_back(t);
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
    for (GrainBodyRow& row : rows) recall_row(all, hs, row);
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

void GrainMemory::store(const GrainTick& tick, const GrainField& grains, const GrainPairList& pairs,
                        std::span<const GrainBodyRow> walls, std::span<const GrainBodyRow> held,
                        double hs, GrainTouches& touches) {
  const auto before = [](const GrainTouch& u, const GrainTouch& v) { return u.before(v); };
  const auto force = [hs](const Vec3& v) {
    return std::array{float(v[0] / hs), float(v[1] / hs), float(v[2] / hs)};
  };
  beside_.clear();
  for (const std::span<const GrainBodyRow> rows : {walls, held})
    for (const GrainBodyRow& r : rows)
      if (r.push > 0)
        beside_.push_back(
            {{float(r.push / hs), force(r.rub), force(r.turn), 0}, grains.key[r.a], r.key});
  std::ranges::sort(beside_, before);
  const auto middle = std::ptrdiff_t(beside_.size());
  beside_.insert(beside_.end(), kept_.begin(), kept_.end());
  std::inplace_merge(beside_.begin(), beside_.begin() + middle, beside_.end(), before);
  const auto from_key = [&](size_t n) {
    return std::ranges::lower_bound(beside_, grains.key[grains.place_of[n]], {}, &GrainTouch::a) -
           beside_.begin();
  };
  // How many each grain has, then where they begin; the range of ordinals of each thread begins at
  // its own part of what stands beside the pairs.
  begins_.resize(grains.size() + 1);
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    size_t at = first < last ? size_t(from_key(first)) : 0;
    for (size_t n = first; n < last; ++n) {
      const uint32_t i = grains.place_of[n];
      uint32_t count = 0;
      for (uint32_t k = pairs.first[i]; k < pairs.first[i + 1]; ++k) count += forces_[k].push > 0;
      for (; at < beside_.size() && beside_[at].a == grains.key[i]; ++at) ++count;
      begins_[n + 1] = count;
    }
  });
  begins_[0] = 0;
  for (size_t n = 0; n < grains.size(); ++n) begins_[n + 1] += begins_[n];
  next_.resize(begins_.back());
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    size_t at = first < last ? size_t(from_key(first)) : 0;
    for (size_t n = first; n < last; ++n) {
      const uint32_t i = grains.place_of[n];
      const uint64_t a = grains.key[i];
      auto to = next_.begin() + std::ptrdiff_t(begins_[n]);
      const auto add_beside = [&](uint64_t end) {
        for (; at < beside_.size() && beside_[at].a == a && beside_[at].b < end; ++at)
          *to++ = beside_[at];
      };
      for (uint32_t k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
        if (!(forces_[k].push > 0)) continue;
        const uint64_t b = grains.key[pairs.all[k].b];
        add_beside(b);
        *to++ = {forces_[k], a, b};
      }
      add_beside(~uint64_t{0});
    }
  });
  touches.replace(next_, grains.size());
}

}  // namespace tumble
