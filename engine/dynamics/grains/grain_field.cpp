#include "engine/dynamics/grains/grain_field.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

double GrainField::rest_speed(const GrainTick& tick, double radius) {
  return tick.settings.sleep_speed * std::sqrt(tick.gravity.norm() * radius);
}

void GrainField::gather(const GrainTick& tick) {
  size_t count = 0;
  first.assign(1, 0);
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (tick.ids.alive(k) && tick.systems[k].grains) count += tick.systems[k].size();
    first.push_back(uint32_t(count));
  }
  owner.resize(count);
  key.resize(count);
  x.resize(count);
  movers.resize(count);
  acceleration.resize(count);
  radius.resize(count);
  asleep.resize(count);
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    const ParticleSystem& p = tick.systems[k];
    const size_t base = first[k];
    for_chunks(tick.crew, first[k + 1] - base, [&](size_t, size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        owner[base + i] = {k, uint32_t(i)};
        key[base + i] = grain_key(k, p.id[i]);
        x[base + i] = p.x[i];
        radius[base + i] = p.radius[i];
        asleep[base + i] = p.rest[i].asleep();
        movers[base + i] = {p.v[i], 0, p.spin[i], 0};
        acceleration[base + i].setZero();
        if (!asleep[base + i]) wake(tick, base + i);
      }
    });
  }
  sleepers = size_t(std::ranges::count(asleep, 1));
  least_radius = largest_radius = 0;
  if (count == 0) return;
  const auto [least, largest] = std::ranges::minmax(radius);
  least_radius = least;
  largest_radius = largest;
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
      p.x[k] = x[i];
      p.v[k] = movers[i].v;
      p.spin[k] = movers[i].spin;
    }
  });
}

size_t GrainField::find(std::span<const ParticleSystem> systems, uint64_t grain) const {
  const auto system = size_t(grain >> 48);
  if (system + 1 >= first.size() || first[system] == first[system + 1]) return size();
  const size_t i = systems[system].find(grain & 0xffffffffffff);
  return i < systems[system].size() ? first[system] + i : size();
}

}  // namespace tumble
