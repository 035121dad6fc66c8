#include "engine/dynamics/grains/grain_field.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace tumble {

namespace {

/// How many grains ahead a grain of a system is fetched: some hundred nanoseconds.
constexpr size_t gather_ahead = 8;

/// Grains lie in their systems in another order than here, each in eight arrays.
void prefetch_grain(const ParticleSystem& p, size_t index) {
  prefetch(&p.x[index]);
  prefetch(&p.v[index]);
  prefetch(&p.spin[index]);
  prefetch(&p.force[index]);
  prefetch(&p.radius[index]);
  prefetch(&p.mass[index]);
  prefetch(&p.id[index]);
  prefetch(&p.rest[index]);
}

}  // namespace

double GrainField::rest_speed(const GrainTick& tick, double radius) {
  return tick.settings.sleep_speed * std::sqrt(tick.gravity.norm() * radius);
}

Status GrainField::line_up(const GrainTick& tick) {
  size_t count = 0;
  first.assign(1, 0);
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (tick.ids.alive(k) && tick.systems[k].grains) count += tick.systems[k].size();
    first.push_back(uint32_t(count));
  }
  by_ordinal_.resize(count);
  least_radius = std::numeric_limits<double>::infinity();
  largest_radius = largest_mass = 0;
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (first[k] == first[k + 1]) continue;
    const ParticleSystem& p = tick.systems[k];
    std::ranges::copy(p.x, by_ordinal_.begin() + std::ptrdiff_t(first[k]));
    const auto [least, largest] = std::ranges::minmax(p.radius);
    least_radius = std::min(least_radius, least);
    largest_radius = std::max(largest_radius, largest);
    largest_mass = std::max(largest_mass, std::ranges::max(p.mass));
  }
  std::atomic<bool> finite = true;
  for_chunks(tick.crew, count, [&](size_t, size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n)
      if (!by_ordinal_[n].allFinite()) finite.store(false, std::memory_order_relaxed);
  });
  if (!finite) return Error{ErrorCode::numeric, "the state of a particle is not finite", {}, {}};
  curve_.line_up(by_ordinal_, tolerances::grain_cell * largest_radius, tick.crew);
  return {};
}

GrainField::Owner GrainField::owner_of(uint32_t n) const {
  const auto after = std::ranges::upper_bound(first, n);
  const auto system = uint32_t(after - first.begin() - 1);
  return {system, n - first[system]};
}

Status GrainField::gather(const GrainTick& tick) {
  if (Status fine = line_up(tick); !fine) return fine;
  const size_t count = by_ordinal_.size();
  owner.resize(count);
  key.resize(count);
  points.resize(count);
  movers.resize(count);
  acceleration.resize(count);
  asleep.resize(count);
  place_of.resize(count);
  ordinal.assign(curve_.order().begin(), curve_.order().end());
  std::array<size_t, chunk_count> sleeping{};
  for_chunks(tick.crew, count, [&](size_t chunk, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Owner later = owner_of(ordinal[std::min(i + gather_ahead, end - 1)]);
      prefetch_grain(tick.systems[later.system], later.index);
      const uint32_t n = ordinal[i];
      place_of[n] = uint32_t(i);
      owner[i] = owner_of(n);
      const auto [k, index] = owner[i];
      const ParticleSystem& p = tick.systems[k];
      key[i] = grain_key(k, p.id[index]);
      points[i] = {p.x[index], p.radius[index]};
      asleep[i] = p.rest[index].asleep();
      movers[i] = {p.v[index], 0, p.spin[index], 0};
      acceleration[i].setZero();
      if (!asleep[i]) wake(tick, i);
      sleeping[chunk] += asleep[i];
    }
  });
  sleepers = std::accumulate(sleeping.begin(), sleeping.end(), size_t{0});
  return {};
}

void GrainField::wake(const GrainTick& tick, size_t i) {
  const auto [k, index] = owner[i];
  const ParticleSystem& p = tick.systems[k];
  movers[i].inverse_mass = 1 / p.mass[index];
  movers[i].inverse_moment = 1 / p.moment(index);
  acceleration[i] = p.gravity_scale * tick.gravity + p.force[index] / p.mass[index];
  asleep[i] = 0;
}

void GrainField::give_back(const GrainTick& tick) const {
  for_chunks(tick.crew, size(), [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      ParticleSystem& p = tick.systems[owner[i].system];
      const uint32_t k = owner[i].index;
      p.x[k] = points[i].x;
      p.v[k] = movers[i].v;
      p.spin[k] = movers[i].spin;
    }
  });
}

size_t GrainField::find(std::span<const ParticleSystem> systems, uint64_t grain) const {
  const auto system = size_t(grain >> 48);
  if (system + 1 >= first.size() || first[system] == first[system + 1]) return size();
  const size_t i = systems[system].find(grain & 0xffffffffffff);
  return i < systems[system].size() ? place_of[first[system] + i] : size();
}

}  // namespace tumble
