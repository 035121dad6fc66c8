#include "engine/dynamics/grains/grain_bundles.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/core/scratch_size.hpp"
#include "engine/dynamics/grains/pair_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Least number of bundles for which threads are worth their cost.
constexpr size_t least_bundles = 16;

uint32_t bundles_for(uint32_t pairs) {
  return uint32_t((pairs + grain_lanes - 1) / grain_lanes);
}

}  // namespace

uint32_t GrainBundles::Counts::bundles() const {
  uint32_t sum = of[colours];
  for (uint32_t c = 0; c < colours; ++c) sum += bundles_for(of[c]);
  return sum;
}

GrainBundles::Slots::Slots(const Counts& counts, uint32_t first_bundle) {
  begin_[0] = first_bundle;
  for (uint32_t c = 0; c < colours; ++c) begin_[c + 1] = begin_[c] + bundles_for(counts.of[c]);
  begin_[colours + 1] = begin_[colours] + counts.of[colours];
}

uint32_t GrainBundles::Slots::take(uint32_t colour) {
  const uint32_t n = taken_[colour]++;
  if (colour == colours) return (begin_[colour] + n) * uint32_t(grain_lanes);
  return begin_[colour] * uint32_t(grain_lanes) + n;
}

void GrainBundles::colour_block(const GrainPairList& pairs, const GrainField& grains,
                                size_t block) {
  const size_t first = block * grain_block, last = std::min(first + grain_block, grains.size());
  std::array<uint64_t, grain_block> used{};
  Counts& counts = counts_[block] = {};
  for (size_t i = first; i < last; ++i)
    for (uint32_t k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
      const size_t j = pairs.all[k].b;
      if (j / grain_block != block) {
        colour_[k] = crosses;
        ++counts.crossing;
        continue;
      }
      const bool moves_i = !grains.asleep[i], moves_j = !grains.asleep[j];
      const uint64_t taken = (moves_i ? used[i - first] : 0) | (moves_j ? used[j - first] : 0);
      const auto c = uint32_t(std::countr_one(taken));
      colour_[k] = uint8_t(c);
      ++counts.of[c];
      if (c == colours) continue;
      if (moves_i) used[i - first] |= uint64_t{1} << c;
      if (moves_j) used[j - first] |= uint64_t{1} << c;
    }
}

void GrainBundles::colour_between(const GrainPairList& pairs, const GrainField& grains) {
  const uint32_t first_bundle = blocks_.empty() ? 0 : blocks_.back().end;
  used_.assign(grains.size(), 0);
  Counts counts;
  for (const uint32_t k : crossing_) {
    const auto [i, j] = pairs.all[k];
    const bool moves_i = !grains.asleep[i], moves_j = !grains.asleep[j];
    const uint64_t taken = (moves_i ? used_[i] : 0) | (moves_j ? used_[j] : 0);
    const auto c = uint32_t(std::countr_one(taken));
    colour_[k] = uint8_t(c);
    ++counts.of[c];
    if (c == colours) continue;
    if (moves_i) used_[i] |= uint64_t{1} << c;
    if (moves_j) used_[j] |= uint64_t{1} << c;
  }
  Slots slots(counts, first_bundle);
  for (const uint32_t k : crossing_) slot_[k] = slots.take(colour_[k]);
  between_.clear();
  for (uint32_t c = 0; c < colours; ++c)
    if (counts.of[c] > 0) between_.push_back({slots.first_of(c), slots.first_of(c + 1)});
  const uint32_t alone = slots.first_of(colours);
  for (uint32_t n = 0; n < counts.of[colours]; ++n) between_.push_back({alone + n, alone + n + 1});
}

void GrainBundles::lay_out(const GrainPairList& pairs, const GrainField& grains, Crew* crew) {
  const size_t blocks = (grains.size() + grain_block - 1) / grain_block;
  colour_.resize(pairs.all.size());
  slot_.resize(pairs.all.size());
  counts_.resize(blocks);
  blocks_.resize(blocks);
  for_chunks(
      crew, blocks,
      [&](size_t, size_t first, size_t last) {
        for (size_t k = first; k < last; ++k) colour_block(pairs, grains, k);
      },
      2);
  uint32_t bundles = 0, crossing = 0;
  for (size_t k = 0; k < blocks; ++k) {
    blocks_[k] = {bundles, bundles + counts_[k].bundles()};
    bundles = blocks_[k].end;
    crossing += std::exchange(counts_[k].crossing, crossing);
  }
  crossing_.resize(crossing);
  source_.resize(bundles * grain_lanes);
  for_chunks(
      crew, blocks,
      [&](size_t, size_t first, size_t last) {
        for (size_t k = first; k < last; ++k)
          fill_block(pairs, grains, k, crossing_.data() + counts_[k].crossing);
      },
      2);
  colour_between(pairs, grains);
  if (!between_.empty()) bundles = between_.back().end;
  source_.resize(bundles * grain_lanes, GrainPairList::none);
  for (const uint32_t k : crossing_) source_[slot_[k]] = k;
  resize_scratch(bundles_, bundles);
}

void GrainBundles::fill_block(const GrainPairList& pairs, const GrainField& grains, size_t block,
                              uint32_t* crossing) {
  const GrainRange& range = blocks_[block];
  std::fill(source_.begin() + range.begin * ptrdiff_t(grain_lanes),
            source_.begin() + range.end * ptrdiff_t(grain_lanes), GrainPairList::none);
  Slots slots(counts_[block], range.begin);
  const size_t end = std::min((block + 1) * grain_block, grains.size());
  for (uint32_t k = pairs.first[block * grain_block]; k < pairs.first[end]; ++k) {
    if (colour_[k] == crosses) {
      *crossing++ = k;
    } else {
      slot_[k] = slots.take(colour_[k]);
      source_[slot_[k]] = k;
    }
  }
}

void GrainBundles::fill(const GrainTick& tick, const GrainPairList& pairs, const GrainField& grains,
                        std::span<GrainForces> forces, double hs) {
  bool turns = false, bounces = false;
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (!tick.ids.alive(k) || !tick.systems[k].grains) continue;
    const GrainDef& def = *tick.systems[k].grains;
    turns = turns || def.rolling_friction > 0 || def.torsional_friction > 0;
    bounces = bounces || tick.systems[k].restitution > 0;
  }
  turnings_.resize(turns ? bundles_.size() : 0);
  bounces_.resize(bounces ? bundles_.size() : 0);
  for_chunks(
      tick.crew, bundles_.size(),
      [&](size_t, size_t first, size_t last) {
        PairMaterial of;
        for (size_t k = first; k < last; ++k) fill_bundle(tick, pairs, grains, forces, hs, of, k);
      },
      least_bundles);
}

GrainBundles::PairMaterial GrainBundles::material(const GrainTick& tick, uint32_t a, uint32_t b) {
  const ParticleSystem &pa = tick.systems[a], &pb = tick.systems[b];
  const auto mean = [same = a == b](double u, double v) { return same ? u : std::sqrt(u * v); };
  return {a,
          b,
          float(mean(pa.friction, pb.friction)),
          mean(pa.grains->rolling_friction, pb.grains->rolling_friction),
          mean(pa.grains->torsional_friction, pb.grains->torsional_friction),
          std::max(pa.restitution, pb.restitution)};
}

void GrainBundles::fill_bundle(const GrainTick& tick, const GrainPairList& pairs,
                               const GrainField& grains, std::span<GrainForces> forces, double hs,
                               PairMaterial& of, size_t k) {
  const uint32_t* source = &source_[k * grain_lanes];
  GrainBundle& to = bundles_[k];
  GrainTurning* turning = turnings_.empty() ? nullptr : &turnings_[k];
  to = {};
  while (to.lanes < grain_lanes && source[to.lanes] != GrainPairList::none) ++to.lanes;
  for (size_t lane = 0; lane < grain_lanes; ++lane) {
    const bool used = lane < to.lanes;
    to.a[lane] = used ? pairs.all[source[lane]].a : to.a[0];
    to.b[lane] = used ? pairs.all[source[lane]].b : to.a[0];
    if (!used) continue;
    prefetch<sizeof(GrainForces)>(&forces[source[lane]]);
    for (const uint32_t i : {to.a[lane], to.b[lane]}) prefetch(&grains.points[i]);
  }
  if (turning) turning->rolling = turning->twisting = {};
  for (size_t lane = 0; lane < to.lanes; ++lane) {
    const uint32_t a = grains.owner[to.a[lane]].system, b = grains.owner[to.b[lane]].system;
    if (a != of.a || b != of.b) of = material(tick, a, b);
    fill_lane(tick, grains, of, k, lane);
  }
  read_forces({forces.data(), source, turning}, float(hs / grains.largest_mass), to);
}

void GrainBundles::fill_lane(const GrainTick& tick, const GrainField& grains,
                             const PairMaterial& of, size_t k, size_t lane) {
  GrainBundle& to = bundles_[k];
  const uint32_t a = to.a[lane], b = to.b[lane];
  to.writes_a = uint16_t(to.writes_a | (grains.asleep[a] ? 0 : 1 << lane));
  to.writes_b = uint16_t(to.writes_b | (grains.asleep[b] ? 0 : 1 << lane));
  const GrainPoint &at_a = grains.points[a], &at_b = grains.points[b];
  const Vec3 way = at_b.x - at_a.x;
  const double distance = way.norm(), reach = at_a.radius + at_b.radius;
  for (size_t c = 0; c < 3; ++c) to.from[c][lane] = to.way[c][lane] = float(way[int(c)]);
  to.reach[lane] = float(reach);
  to.share[lane] = float(at_a.radius / reach);
  to.gap[lane] = float(distance - reach);
  to.friction[lane] = of.friction;
  if (!turnings_.empty()) {
    const double lever = 2 * at_a.radius * at_b.radius / reach;
    turnings_[k].rolling[lane] = float(lever * of.rolling);
    turnings_[k].twisting[lane] = float(lever * of.twisting);
  }
  const double threshold = tick.settings.restitution_threshold;
  if (of.restitution == 0) return;
  const Vec3 relative = grains.movers[b].v - grains.movers[a].v;
  if (relative.squaredNorm() < threshold * threshold) return;
  const double approach = (distance > 0 ? Vec3(way / distance) : Vec3::UnitY()).dot(relative);
  if (approach > -threshold) return;
  // Where two that are apart meet, they approach by less than now, unless they meet centrally: on a
  // straight path the speed across it grows as their distance falls.
  const double nearing = std::max(1.0, distance / reach);
  const double square = relative.squaredNorm(),
               normal = square - nearing * nearing * (square - approach * approach);
  if (normal < threshold * threshold) return;
  if (!to.bounces) bounces_[k] = {};
  to.bounces = true;
  bounces_[k].speed[lane] = float(of.restitution * std::sqrt(normal));
}

double GrainBundles::read(const GrainField& grains, std::span<GrainForces> forces, double hs,
                          Crew* crew) {
  std::array<float, chunk_count> deepest{};
  const double force = grains.largest_mass / hs;
  for_chunks(
      crew, bundles_.size(),
      [&](size_t chunk, size_t first, size_t last) {
        for (size_t k = first; k < last; ++k)
          deepest[chunk] = std::max(deepest[chunk], read_bundle(forces, force, k));
      },
      least_bundles);
  return double(std::ranges::max(deepest));
}

/// Reads the forces of a bundle, `unit` newtons per impulse; returns its greatest overlap, or 0.
float GrainBundles::read_bundle(std::span<GrainForces> forces, double unit, size_t k) {
  const GrainBundle& from = bundles_[k];
  write_forces(
      {forces.data(), &source_[k * grain_lanes], turnings_.empty() ? nullptr : &turnings_[k]},
      float(unit), from);
  float deepest = 0;
  for (size_t lane = 0; lane < from.lanes; ++lane) deepest = std::max(deepest, -from.gap[lane]);
  return deepest;
}

}  // namespace tumble
