// Bodies that jam by friction, under the event stepper with its way out of ticks in which no forces
// are found: time-stepping. References: the balance of energy, and the overlap that the event
// stepper promises where it goes alone.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

Quat tilted(double angle) {
  return axis_angle(Vec3::UnitZ(), angle);
}

void fix(TestWorld& w, ShapeDef shape, const Vec3& x, double friction) {
  BodyDef d = body(std::move(shape), x, friction);
  d.type = BodyType::fixed;
  w.add(d);
}

/// Slabs that are thrown against a wall over a floor.
void add_slabs(TestWorld& w, Random& r) {
  r.uniform();
  fix(w, half_space(), Vec3::Zero(), r.uniform(0, 2));
  fix(w, box(0.1, 5, 5), {1.1, 5, 0}, r.uniform(0.8, 2));
  const int slabs = 1 + int(r.uniform(0, 3));
  for (int i = 0; i < slabs; ++i) {
    const double friction = r.uniform(0.5, 2), z = r.uniform(0.02, 0.1), y = r.uniform(0.3, 0.8),
                 x = r.uniform(0.02, 0.1);
    BodyDef d = body(box(x, y, z), {0.2 - 0.7 * i, 0.9, 0}, friction);
    d.pose.q = tilted(r.uniform(-1.3, 1.3));
    d.velocity = {r.uniform(0, 6), 0, 0};
    d.angular_velocity = {0, 0, r.uniform(-3, 3)};
    w.add(d);
  }
}

/// Rods that slide on a block that slides on a floor.
void add_riders(TestWorld& w, Random& r) {
  const double friction = r.uniform(0.8, 2);
  fix(w, half_space(), Vec3::Zero(), 0.8 * friction);
  BodyDef block = body(box(0.5, 0.1, 0.5), {0, 0.1, 0}, friction);
  block.velocity = {r.uniform(-3, 3), 0, 0};
  w.add(block);
  const int rods = 1 + int(r.uniform(0, 3));
  for (int i = 0; i < rods; ++i) {
    const double length = r.uniform(0.5, 2), radius = r.uniform(0.01, 0.05),
                 angle = r.uniform(0.2, 1.3) * (r.uniform() < 0.5 ? -1 : 1);
    BodyDef d =
        body(capsule(radius, length),
             {0, 0.2 + radius + 0.5 * length * std::cos(angle) + 1e-4, -0.3 + 0.3 * i}, friction);
    d.pose.q = tilted(angle);
    d.pose.x.x() = 0.5 * length * std::sin(angle) * r.uniform(-1, 1);
    d.velocity = {r.uniform(-4, 4), 0, 0};
    w.add(d);
  }
}

/// Drawers in a shaft that they fill but for a little.
void add_drawers(TestWorld& w, Random& r) {
  const double friction = r.uniform(0.8, 2), room = r.uniform(1e-4, 5e-3),
               width = r.uniform(0.1, 0.5), length = r.uniform(0.05, 0.5);
  WorldSettings s = w->settings();
  s.gravity = {r.uniform(-5, 5), r.uniform(-12, 0), 0};
  REQUIRE(w->set_settings(s).ok());
  w.apply();
  for (const int side : {-1, 1})
    fix(w, box(0.1, 10, 1), {side * (0.1 + width + room), 0, 0}, friction);
  const int drawers = 1 + int(r.uniform(0, 3));
  double y = 0;
  for (int i = 0; i < drawers; ++i) {
    BodyDef d = body(box(width, length, 0.2), {0, y, 0}, friction);
    d.velocity = {0, r.uniform(-5, 5), 0};
    d.angular_velocity = {0, 0, r.uniform(-3, 3)};
    w.add(d);
    y += 2 * length + r.uniform(0.01, 0.2);
  }
}

/// Ticks, each of which must find its answer and take energy. Gives how many were time-stepped.
int run_jammed_world(void (*add)(TestWorld&, Random&), int seed, int ticks) {
  if (test::only_to_run()) ticks = std::min(ticks, 8);
  WorldSettings settings;
  settings.stepper = "event";
  TestWorld w(settings, 1, "said once");
  Random r{uint64_t(seed)};
  add(w, r);
  const auto energy_now = [&] { return w->frame()->stats.energies.total(); };
  double energy = energy_now(), deepest = 0;
  int time_stepped = 0;
  for (int k = 0; k < ticks; ++k) {
    CAPTURE(seed);
    CAPTURE(k);
    time_stepped += w.step().stats.time_stepped > 0;
    const double now = energy_now();
    // Of a time-stepped tick a millionth or so is the error of its integrator.
    CHECK(now - energy < 1e-5 * (1 + std::fabs(energy)));
    deepest = std::max(deepest, w->frame()->stats.max_penetration);
    energy = now;
  }
  CHECK(deepest < (time_stepped > 0 ? 1e-3 : 1e-7));
  return time_stepped;
}

}  // namespace

TEST_CASE("event: slabs, riders and drawers that jam go on, and gain no energy") {
  int time_stepped = 0;
  for (const int seed : {11013, 11029, 11042})
    time_stepped += run_jammed_world(add_slabs, seed, 45);
  time_stepped += run_jammed_world(add_riders, 7062, 20);
  for (const int seed : {3024, 3056, 3106, 3116})
    time_stepped += run_jammed_world(add_drawers, seed, 50);
  if (!test::only_to_run()) CHECK(time_stepped > 0);
}
