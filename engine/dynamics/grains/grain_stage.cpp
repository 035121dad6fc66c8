#include "engine/dynamics/grains/grain_stage.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace tumble {
namespace {

void copy_places(const GrainField& grains, std::vector<Vec3>& to, Crew* crew) {
  to.resize(grains.size());
  for_chunks(crew, grains.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) to[i] = grains.points[i].x;
  });
}

/// Whether all grains sleep, as after the last tick, and nothing moves that could wake them.
bool all_rest(const GrainTick& tick, const GrainTouches& touches) {
  size_t count = 0;
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (!tick.ids.alive(k) || !tick.systems[k].grains) continue;
    count += tick.systems[k].size();
    if (!std::ranges::all_of(tick.systems[k].rest, &GrainRest::asleep)) return false;
  }
  return count > 0 && count == touches.grains() &&
         std::ranges::none_of(tick.bodies.bodies,
                              [](const RigidBody& b) { return b.awake() && !b.shapes.empty(); });
}

/// The greatest number that settings or any system ask for, since grains of different systems mix.
int substeps_of_tick(const GrainTick& tick) {
  int most = tick.settings.substeps;
  for (uint32_t k = 0; k < tick.systems.size(); ++k)
    if (tick.ids.alive(k) && tick.systems[k].grains)
      most = std::max(most, tick.systems[k].grains->substeps);
  return most;
}

}  // namespace

bool GrainStage::asked_for(const HandlePool<ParticleSystemTag>& ids,
                           std::span<const ParticleSystem> systems) {
  for (uint32_t k = 0; k < systems.size(); ++k)
    if (ids.alive(k) && systems[k].grains && systems[k].size() > 0) return true;
  return false;
}

/// Number of parts of a tick that keeps approaches short: of any two grains, and of groups of
/// grains. A few fast grains on a heap at rest do not divide the tick.
int GrainStage::parts_of(const GrainTick& tick) const {
  struct Speeds {
    Aabb single, groups;
  };
  constexpr size_t group = tolerances::grain_group;
  std::array<Speeds, chunk_count> speeds;
  for_chunks(tick.crew, (grains_.size() + group - 1) / group,
             [&](size_t chunk, size_t first, size_t last) {
               for (size_t k = first; k < last; ++k) {
                 const size_t begin = k * group, end = std::min(begin + group, grains_.size());
                 Vec3 sum = Vec3::Zero();
                 for (size_t i = begin; i < end; ++i) {
                   speeds[chunk].single.include(grains_.movers[i].v);
                   sum += grains_.movers[i].v;
                 }
                 speeds[chunk].groups.include(sum / double(end - begin));
               }
             });
  Speeds all;
  for (const Speeds& s : speeds) {
    all.single.include(s.single);
    all.groups.include(s.groups);
  }
  const auto parts = [&](const Aabb& v, double most) {
    const double fastest = v.extent().norm() + tick.gravity.norm() * tick.h;
    return std::ceil(fastest * tick.h / (most * grains_.least_radius));
  };
  return int(std::clamp(std::max(parts(all.single, tolerances::grain_part),
                                 parts(all.groups, tolerances::grain_group_part)),
                        1.0, double(tolerances::most_grain_parts)));
}

void GrainStage::wake_again(const GrainTick& tick, size_t i) {
  if (!grains_.asleep[i]) return;
  grains_.wake(tick, i);
  --grains_.sleepers;
}

/// If grains have been removed since the last tick, wakes those that leaned on them.
void GrainStage::wake_lost(const GrainTick& tick, const GrainTouches& touches) {
  if (touches.grains() == grains_.size() || grains_.sleepers == 0) return;
  for (const GrainTouch& t : touches.all()) {
    if (t.on_body()) continue;
    const size_t a = grains_.find(tick.systems, t.a), b = grains_.find(tick.systems, t.b);
    if (a == grains_.size() && b < grains_.size()) wake_again(tick, b);
    if (b == grains_.size() && a < grains_.size()) wake_again(tick, a);
  }
}

Status GrainStage::step(const GrainTick& tick, GrainTouches& touches, GrainReport& report) {
  report = {};
  if (bodies_.carried().empty() && all_rest(tick, touches)) {
    age(tick);
    return {};
  }
  bodies_.take_back(tick, report);
  if (Status fine = grains_.gather(tick); !fine) return fine;
  if (grains_.size() == 0) {
    touches.loads().clear();
    return {};
  }
  wake_lost(tick, touches);
  shapes_.collect(tick, grains_);
  shapes_.rouse(tick, grains_);
  if (grains_.sleepers == grains_.size() && bodies_.carried().empty()) {
    age(tick);
    return {};
  }
  report.moved = true;
  bodies_.begin_tick(tick);
  copy_places(grains_, start_, tick.crew);
  const int parts = parts_of(tick);
  const int substeps = (substeps_of_tick(tick) + parts - 1) / parts;
  for (int k = 0; k < parts && !stop_requested(); ++k)
    if (Status done =
            part(tick, touches, tick.h * k / parts, tick.h * (k + 1) / parts, substeps, report);
        !done)
      return done;
  if (stop_requested()) return stopped_error();
  grains_.give_back(tick);
  age(tick);
  rest_.watch(tick, grains_, start_, pairs_, memory_.forces(), bodies_, report);
  report.awake = grains_.size() - grains_.sleepers;
  bodies_.give(tick, touches, report);
  return {};
}

Status GrainStage::part(const GrainTick& tick, GrainTouches& touches, double t0, double t1,
                        int substeps, GrainReport& report) {
  const double h = t1 - t0, hs = h / substeps;
  if (Status found = finder_.find(tick, grains_, h, pairs_); !found) return found;
  if (stop_requested()) return stopped_error();
  shapes_.touch(tick, grains_, t0, t1, touching_);
  bodies_.make_rows(tick, grains_, shapes_, touching_, report);
  memory_.recall(tick, grains_, touches, pairs_, bodies_.walls(), bodies_.held(), hs);
  if (stop_requested()) return stopped_error();
  bundles_.lay_out(pairs_, grains_, tick.crew);
  if (stop_requested()) return stopped_error();
  bundles_.fill(tick, pairs_, grains_, memory_.forces(), hs);
  if (stop_requested()) return stopped_error();
  find_touched(tick.crew);
  copy_places(grains_, from_, tick.crew);
  const GrainPairWork work =
      solve_grains({grains_.points, grains_.movers, grains_.acceleration, touched_,
                    grains_.largest_mass, motion_, bundles_, bodies_.all(), bodies_.walls(),
                    bodies_.held(), tick.settings.restitution_threshold},
                   substeps, hs, tick.crew);
  if (stop_requested()) return stopped_error();
  auto held = shapes_.hold_back(tick, grains_, from_, t0, t1);
  if (!held) return held.error();
  report.held += *held;
  count(tick.crew, work, report);
  if (stop_requested()) return stopped_error();
  report.deepest =
      std::max(report.deepest, bundles_.read(grains_, memory_.forces(), hs, tick.crew));
  if (stop_requested()) return stopped_error();
  memory_.store(tick, grains_, pairs_, bodies_.walls(), bodies_.held(), hs, touches);
  for (const uint32_t i : memory_.lost()) wake_again(tick, i);
  return {};
}

void GrainStage::find_touched(Crew* crew) {
  touched_.assign(grains_.size(), 0);
  // Several threads may mark a grain, all in the same way.
  const auto mark = [this](uint32_t i) {
    std::atomic_ref<uint8_t>(touched_[i]).store(1, std::memory_order_relaxed);
  };
  for_chunks(crew, pairs_.all.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      mark(pairs_.all[k].a);
      mark(pairs_.all[k].b);
    }
  });
  for (const std::span<GrainBodyRow> rows : {bodies_.walls(), bodies_.held()})
    for (const GrainBodyRow& row : rows) touched_[row.a] = 1;
}

void GrainStage::count(Crew* crew, const GrainPairWork& work, GrainReport& report) const {
  report.contacts = pairs_.all.size() + bodies_.walls().size() + bodies_.held().size();
  report.restitution.work += work.lost;
  report.friction.work += work.rubbed;
  bodies_.count(crew, report);
}

/// Adds to the grains' ages, and clears their forces.
void GrainStage::age(const GrainTick& tick) const {
  for (uint32_t k = 0; k < tick.systems.size(); ++k) {
    if (!tick.ids.alive(k) || !tick.systems[k].grains) continue;
    ParticleSystem& p = tick.systems[k];
    for_chunks(tick.crew, p.size(), [&](size_t, size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        p.age[i] += tick.h;
        p.force[i].setZero();
      }
    });
  }
}

}  // namespace tumble
