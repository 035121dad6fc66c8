#include "engine/dynamics/rigid/sleeping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

/// Speed of the fastest point of a body in multiples of the speed below which it rests.
double liveliness(const RigidBody& body, double gravity, double sleep_speed) {
  const double r = body.bounding_radius;
  const double speed = body.v.norm() + r * body.omega.norm();
  // Without gravity nothing holds a body in place: only what is as good as still may sleep.
  const double pull = gravity * std::abs(body.gravity_scale);
  return speed / std::max(sleep_speed * std::sqrt(pull * r), 1e-4 * r);
}

/// Bodies that rock on two points or spin on one would do so for ever: below `range` times the
/// speed of rest their motion decays, the more the slower.
void settle(RigidBody& body, double lively, double rate, double h) {
  constexpr double range = 5;
  if (lively >= range) return;
  const double keep = 1 / (1 + h * rate * (1 - lively / range));
  body.v *= keep;
  body.omega *= keep;
}

}  // namespace

uint32_t update_sleeping(std::span<RigidBody> bodies, const IslandSet& islands, double gravity,
                         double h, const RealtimeSettings& settings) {
  uint32_t fallen_asleep = 0;
  for (const Island& island : islands.islands) {
    const bool touches = island.contact_begin < island.contact_end;
    double rested = std::numeric_limits<double>::infinity();
    for (uint32_t k = island.body_begin; k < island.body_end; ++k) {
      RigidBody& body = bodies[islands.bodies[k]];
      const double lively = liveliness(body, gravity, settings.sleep_speed);
      if (settings.sleeping && touches) settle(body, lively, settings.settling, h);
      const bool rests = settings.sleeping && body.can_sleep && !island.restless && lively < 1;
      body.sleep_time = rests ? body.sleep_time + h : 0;
      rested = std::min(rested, body.sleep_time);
    }
    if (!settings.sleeping || rested < settings.sleep_time || rested <= 0) continue;
    ++fallen_asleep;
    for (uint32_t k = island.body_begin; k < island.body_end; ++k) {
      RigidBody& body = bodies[islands.bodies[k]];
      body.asleep = true;
      body.v.setZero();
      body.omega.setZero();
    }
  }
  return fallen_asleep;
}

void wake(RigidBody& body) {
  body.asleep = false;
  body.sleep_time = 0;
}

void wake_touching(std::span<RigidBody> bodies, const ContactSet& contacts, uint32_t body) {
  for (const Contact& c : contacts.contacts()) {
    if (c.key.body_a == body) wake(bodies[c.key.body_b]);
    if (c.key.body_b == body) wake(bodies[c.key.body_a]);
  }
}

void wake_all(std::span<RigidBody> bodies) {
  for (RigidBody& body : bodies) wake(body);
}

}  // namespace tumble
