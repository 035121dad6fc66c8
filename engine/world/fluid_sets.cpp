#include "engine/world/fluid_sets.hpp"

#include "engine/math/det/det.hpp"
#include "engine/world/fluids.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

double spacing_of(const ParticleSystem& p) {
  const double mass = std::accumulate(p.mass.begin(), p.mass.end(), 0.0);
  return det::pow(mass / (p.fluid->density * double(p.size())), 1.0 / 3);
}

bool together(const ParticleSystem& a, const ParticleSystem& b) {
  if (!can_be_solved_together(*a.fluid, *b.fluid)) return false;
  const double one = spacing_of(a), other = spacing_of(b);
  return std::max(one, other) <= tolerances::most_spacing_ratio * std::min(one, other);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::vector<std::vector<uint32_t>> fluid_sets(const WorldState& s) {
  // The fluid of a particle is stored in a byte.
  constexpr size_t most = 256;
  std::vector<std::vector<uint32_t>> sets;
  for (uint32_t k = 0; k < s.particles.size(); ++k) {
    if (!is_live_fluid(s, k)) continue;
    const auto takes = [&](const std::vector<uint32_t>& set) {
      return set.size() < most && together(s.particles[set[0]], s.particles[k]);
    };
    const auto found = std::ranges::find_if(sets, takes);
    if (found == sets.end())
      sets.push_back({k});
    else
      found->push_back(k);
  }
  return sets;
}

void gather_fluids(const WorldState& s, std::span<const uint32_t> set,
                   FluidWorkspace::Together& to) {
  to.defs.clear(), to.first.clear(), to.fluid.clear(), to.acceleration.clear();
  to.x.clear(), to.v.clear(), to.pressure.clear(), to.mass.clear();
  for (const uint32_t k : set) {
    const ParticleSystem& p = s.particles[k];
    to.first.push_back(to.x.size());
    to.fluid.insert(to.fluid.end(), p.size(), uint8_t(to.defs.size()));
    to.defs.push_back(p.fluid.get());
    append(to.x, p.x), append(to.v, p.v), append(to.pressure, p.pressure), append(to.mass, p.mass);
    const Vec3 g = p.gravity_scale * s.settings.gravity.now();
    for (size_t i = 0; i < p.size(); ++i) to.acceleration.push_back(g + p.force[i] / p.mass[i]);
  }
  to.x_before = to.x, to.v_before = to.v;
}

void scatter_fluids(WorldState& s, std::span<const uint32_t> set, std::span<const double> shares,
                    const FluidWorkspace::Together& from) {
  for (size_t n = 0; n < set.size(); ++n) {
    ParticleSystem& p = s.particles[set[n]];
    p.density.resize(p.size());
    for (size_t i = 0; i < p.size(); ++i) {
      const size_t at = from.first[n] + i;
      p.x[i] = from.x[at], p.v[i] = from.v[at], p.pressure[i] = from.pressure[at];
      p.density[i] = shares[at] * p.fluid->density;
    }
  }
}

}  // namespace tumble
