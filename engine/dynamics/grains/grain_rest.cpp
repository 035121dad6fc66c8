#include "engine/dynamics/grains/grain_rest.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

namespace tumble {
namespace {

GrainRest& rest_of(const GrainTick& tick, const GrainField& grains, size_t i) {
  return tick.systems[grains.owner[i].system].rest[grains.owner[i].index];
}

}  // namespace

/// Updates for how long awake grains have been slow; returns whether any has been for long enough.
bool GrainRestWatch::time_slow(const GrainTick& tick, const GrainField& grains,
                               std::span<const Vec3> start) {
  const double share = tick.h / (tick.h + tolerances::grain_watch);
  restless_.assign(grains.size(), 0);
  std::atomic<bool> any = false;
  for_chunks(tick.crew, grains.size(), [&](size_t, size_t first, size_t last) {
    bool enough = false;
    for (size_t i = first; i < last; ++i) {
      if (grains.asleep[i]) continue;
      const GrainMover& m = grains.movers[i];
      const double radius = grains.points[i].radius;
      GrainRest& r = rest_of(tick, grains, i);
      if (r.asleep()) r = {};
      r.drift += share * ((grains.points[i].x - start[i]) / tick.h - r.drift);
      const double slow = GrainField::rest_speed(tick, radius);
      const double now = m.v.norm() + radius * m.spin.norm();
      const bool rests = r.drift.norm() < slow && now < tolerances::grain_wakes * slow;
      r.time = rests ? r.time + tick.h : 0;
      restless_[i] = r.time < 0.5 * tick.settings.sleep_time;
      enough = enough || r.time >= tick.settings.sleep_time;
    }
    if (enough) any.store(true, std::memory_order_relaxed);
  });
  return any;
}

void GrainRestWatch::find_held(const GrainTick& tick, const GrainField& grains,
                               const GrainPairList& pairs, std::span<const GrainForces> forces,
                               const GrainBodies& bodies) {
  hold_.assign(grains.size(), Hold::none);
  // Bitwise "or" gives the same result for any order of threads.
  const auto grasp = [this](size_t i, bool restless) {
    const uint8_t added = restless ? Hold::restless : Hold::firm;
    const std::atomic_ref<uint8_t> hold(hold_[i]);
    if ((hold.load(std::memory_order_relaxed) & added) == 0)
      hold.fetch_or(added, std::memory_order_relaxed);
  };
  for_chunks(tick.crew, pairs.all.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      if (!(forces[k].push > 0)) continue;
      const auto [a, b] = pairs.all[k];
      grasp(a, restless_[b] != 0);
      grasp(b, restless_[a] != 0);
    }
  });
  for (const std::span<const GrainBodyRow> rows : {bodies.walls(), bodies.held()})
    for_chunks(tick.crew, rows.size(), [&](size_t, size_t first, size_t last) {
      for (const GrainBodyRow& row : rows.subspan(first, last - first)) {
        if (!(row.push > 0)) continue;
        const RigidBody& body = tick.bodies.bodies[bodies.all()[row.b].slot];
        grasp(row.a,
              body.awake() && (body.dynamic() || !body.v.isZero(0) || !body.omega.isZero(0)));
      }
    });
}

void GrainRestWatch::watch(const GrainTick& tick, GrainField& grains, std::span<const Vec3> start,
                           const GrainPairList& pairs, std::span<const GrainForces> forces,
                           const GrainBodies& bodies, GrainReport& report) {
  const bool any = time_slow(tick, grains, start);
  if (!tick.settings.sleeping || !any) return;
  find_held(tick, grains, pairs, forces, bodies);
  for (const uint32_t i : grains.place_of) {
    if (grains.asleep[i] || hold_[i] != Hold::firm) continue;
    GrainRest& r = rest_of(tick, grains, i);
    if (r.time < tick.settings.sleep_time) continue;
    ParticleSystem& p = tick.systems[grains.owner[i].system];
    const uint32_t k = grains.owner[i].index;
    const Vec3 momentum = p.mass[k] * p.v[k], turning = p.moment(k) * p.spin[k];
    report.sleeping.work -= 0.5 * (p.v[k].dot(momentum) + p.spin[k].dot(turning));
    report.sleeping.momentum -= momentum;
    report.sleeping.angular_momentum -= p.x[k].cross(momentum) + turning;
    p.v[k].setZero();
    p.spin[k].setZero();
    r = {Vec3::Zero(), std::numeric_limits<double>::infinity()};
    ++grains.sleepers;
  }
}

}  // namespace tumble
