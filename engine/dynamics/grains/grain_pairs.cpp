#include "engine/dynamics/grains/grain_pairs.hpp"

#include "engine/collision/particle_contacts/gather.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct NoGrainMemory {};

}  // namespace

template <class F>
void GrainPairs::near(size_t i, const F& f) const {
  const uint32_t place = places_[i], count = lists_.count(place);
  const std::span<const uint32_t> of = lists_.of(place);
  for (uint32_t k = 0; k < count; ++k) f(lists_.order()[of[k]]);
}

void GrainPairs::rouse(const GrainTick& tick, GrainField& grains) {
  if (grains.sleepers == 0 || grains.sleepers == grains.size()) return;
  std::vector<uint32_t> roused;
  gather_found<NoGrainMemory>(
      tick.crew, grains.size(), roused, [&](size_t i, NoGrainMemory&, std::vector<uint32_t>& out) {
        if (grains.asleep[i]) return;
        const double r = grains.radius[i];
        const double slow = tolerances::grain_wakes * GrainField::rest_speed(tick, r);
        if (grains.movers[i].v.norm() + r * grains.movers[i].spin.norm() <= slow) return;
        near(i, [&](uint32_t j) {
          if (!grains.asleep[j]) return;
          const double reach = (r + grains.radius[j]) * (1 + tolerances::grain_margin);
          if ((grains.x[j] - grains.x[i]).squaredNorm() <= reach * reach) out.push_back(j);
        });
      });
  for (const uint32_t i : roused) {
    if (!grains.asleep[i]) continue;
    grains.wake(tick, i);
    --grains.sleepers;
  }
}

Status GrainPairs::find(const GrainTick& tick, GrainField& grains, double h, double speed,
                        std::vector<std::pair<uint32_t, uint32_t>>& out) {
  // Few different reaches, so that lists stay.
  const double margin = tolerances::grain_margin + h * speed / grains.largest_radius;
  double level = tolerances::grain_foresight;
  while (0.5 * level >= margin) level *= 0.5;
  const NeighbourLists::Request request{.reach = grains.largest_radius * (2 + level),
                                        .skin = grains.largest_radius * tolerances::grain_skin};
  if (const auto made = lists_.update(grains.x, request, tick.crew); !made) return made.error();
  places_.resize(grains.size());
  for (uint32_t place = 0; place < lists_.size(); ++place) places_[lists_.order()[place]] = place;
  rouse(tick, grains);
  const auto find = [&](size_t i, NoGrainMemory&,
                        std::vector<std::pair<uint32_t, uint32_t>>& found) {
    if (grains.asleep[i]) return;
    const size_t begin = found.size();
    const double r = grains.radius[i];
    near(i, [&](uint32_t j) {
      if (j < i && !grains.asleep[j]) return;
      const double least = std::min(r, grains.radius[j]);
      const double closing = (grains.movers[j].v - grains.movers[i].v).norm();
      const double reach = r + grains.radius[j] + least * tolerances::grain_margin +
                           std::min(least * tolerances::grain_foresight, h * closing);
      if ((grains.x[j] - grains.x[i]).squaredNorm() <= reach * reach)
        found.push_back(std::minmax(uint32_t(i), j));
    });
    std::sort(found.begin() + std::ptrdiff_t(begin), found.end());
  };
  gather_found<NoGrainMemory>(tick.crew, grains.size(), out, find);
  if (!std::ranges::is_sorted(out)) std::ranges::sort(out);
  return {};
}

}  // namespace tumble
