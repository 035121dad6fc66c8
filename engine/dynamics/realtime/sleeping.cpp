#include "engine/dynamics/realtime/sleeping.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

/// Speed below which a body rests [m/s], with ticks of h seconds. `pull` is the acceleration that
/// holds it in place [m/s2]: without it only nearly motionless bodies may sleep; with it, the speed
/// is limited so that a large body cannot stay below it in free flight for `sleep_time`.
double resting_speed(const RigidBody& body, double pull, const RealtimeSettings& settings,
                     double h) {
  const double r = body.bounding_radius;
  const double slow =
      std::max(settings.sleep_speed * std::sqrt(pull * r), tolerances::weightless_rest * r);
  return pull > 0
             ? std::min(slow, tolerances::slow_in_flight * pull * std::max(settings.sleep_time, h))
             : slow;
}

void lay_down(RigidBody& body) {
  body.asleep = true;
  body.v.setZero();
  body.omega.setZero();
  body.force.setZero();
  body.torque.setZero();
  body.rest = {};
}

/// Counts for how long the speed bound of the body's points, averaged exponentially over `span`,
/// has been below `resting`: deep in a pile contacts tremble because points press in turn, without
/// net motion. Averages of velocities, unlike differences of positions, stay accurate far from the
/// origin.
void watch(RigidBody& body, double resting, double span, bool may_rest, double h) {
  RestWatch& rest = body.rest;
  const double share = h / (h + span);
  rest.v += share * (body.v - rest.v);
  rest.omega += share * (body.omega - rest.omega);
  const bool still = rest.v.norm() + body.bounding_radius * rest.omega.norm() < resting;
  rest.time = may_rest && still ? rest.time + h : 0;
}

}  // namespace

uint32_t update_sleeping(std::span<RigidBody> bodies, const IslandSet& islands, double gravity,
                         double h, const RealtimeSettings& settings, SleepScratch& scratch,
                         Crew* crew) {
  const std::span<const uint32_t> members = islands.bodies;
  const auto each_member = [&](const auto& f) {
    for_chunks(crew, members.size(), [&](size_t, size_t first, size_t last) {
      for (size_t k = first; k < last; ++k) f(k, bodies[members[k]]);
    });
  };
  const auto island_of = [&](size_t k) { return islands.island_of[members[k]] - 1; };
  scratch.rested.resize(members.size());
  each_member([&](size_t k, RigidBody& body) {
    const double pull = gravity * std::abs(body.gravity_scale);
    const bool may_rest =
        settings.sleeping && body.can_sleep && !islands.islands[island_of(k)].restless;
    watch(body, resting_speed(body, pull, settings, h),
          tolerances::averaged_of_sleep_time * settings.sleep_time, may_rest, h);
    scratch.rested[k] = body.rest.time;
  });
  if (!settings.sleeping) return 0;
  uint32_t fallen_asleep = 0;
  for (const Island& island : islands.islands) {
    const auto rested =
        std::span(scratch.rested).subspan(island.body_begin, island.body_end - island.body_begin);
    const double least = std::ranges::min(rested);
    if (least < settings.sleep_time || least <= 0) continue;
    ++fallen_asleep;
    for (uint32_t k = island.body_begin; k < island.body_end; ++k) lay_down(bodies[members[k]]);
  }
  return fallen_asleep;
}

}  // namespace tumble
