#include "engine/dynamics/realtime/sleeping.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

/// Speed of the fastest point of a body in multiples of `resting` [m/s].
double liveliness(const RigidBody& body, double resting) {
  return (body.v.norm() + body.bounding_radius * body.omega.norm()) / resting;
}

/// Speed [m/s] below which a body rests. `pull` is the acceleration that holds it in place: without
/// one only what is as good as still may sleep.
double resting_speed(const RigidBody& body, double pull, double sleep_speed) {
  const double r = body.bounding_radius;
  return std::max(sleep_speed * std::sqrt(pull * r), tolerances::weightless_rest * r);
}

/// Bound on how far any point of the body is from where it was in `pose` [m].
double departure(const RigidBody& body, const Pose& pose) {
  const double half_sine = std::min(1.0, (body.pose.q * pose.q.conjugate()).vec().norm());
  return (body.pose.x - pose.x).norm() + 2 * body.bounding_radius * half_sine;
}

/// Deep in a pile contacts tremble for ever as their points take turns: what gets nowhere by it and
/// is held by gravity alone rests too, up to this multiple of the resting speed. `allowed` is how
/// far [m] rest lets it go.
bool trembles(const RigidBody& body, double lively, double pull, double allowed) {
  return lively < tolerances::trembling &&
         body.force.norm() <= tolerances::negligible_force * body.mass * pull &&
         departure(body, body.rest.pose) < allowed;
}

/// Bodies that rock on two points or spin on one would do so for ever: below `range` times the
/// speed of rest their motion decays, the more the slower.
void settle(RigidBody& body, double lively, double rate, double h) {
  constexpr double range = tolerances::settling_range;
  if (lively >= range) return;
  const double keep = 1 / (1 + h * rate * (1 - lively / range));
  body.v *= keep;
  body.omega *= keep;
}

/// Whether something besides gravity pulls the body along: springs, wind, a hand.
bool pulled_along(const RigidBody& body) {
  return body.force.dot(body.v) > 0 || body.torque.dot(body.omega) > 0;
}

void lay_down(RigidBody& body) {
  body.asleep = true;
  body.v.setZero();
  body.omega.setZero();
  body.force.setZero();
  body.torque.setZero();
}

/// Counts for how long the body has been at rest.
void watch(RigidBody& body, bool rests, double h) {
  if (rests) {
    body.rest.time += h;
  } else {
    body.rest = {body.pose, 0};
  }
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
  // What is slow because it was just set in motion must not be held back.
  scratch.pulled.resize(members.size());
  if (settings.sleeping)
    each_member([&](size_t k, const RigidBody& body) { scratch.pulled[k] = pulled_along(body); });
  const size_t count = islands.islands.size();
  scratch.settles.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Island& island = islands.islands[i];
    const auto pulled =
        std::span(scratch.pulled).subspan(island.body_begin, island.body_end - island.body_begin);
    scratch.settles[i] = settings.sleeping && island.contact_begin < island.contact_end &&
                         std::ranges::none_of(pulled, [](uint8_t p) { return p != 0; });
  }
  scratch.rested.resize(members.size());
  each_member([&](size_t k, RigidBody& body) {
    const size_t i = island_of(k);
    const double pull = gravity * std::abs(body.gravity_scale);
    const double resting = resting_speed(body, pull, settings.sleep_speed);
    const double lively = liveliness(body, resting);
    if (scratch.settles[i]) settle(body, lively, settings.settling, h);
    const bool still = lively < 1 || trembles(body, lively, pull, resting * settings.sleep_time);
    watch(body, settings.sleeping && body.can_sleep && !islands.islands[i].restless && still, h);
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
