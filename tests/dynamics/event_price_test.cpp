// The price of a tick of the event stepper. References: the budget that was given; the same run
// with a budget that is never reached, bit by bit.
#include "engine/core/random.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "tests/dynamics/event_world.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Leaves its bodies where they are.
class NoMotion final : public TimeStepping {
 public:
  Status advance(std::span<const uint32_t>) override {
    ++calls;
    return {};
  }
  int calls = 0;
};

/// Boxes thrown onto each other on a table: many contacts that come and go.
void throw_boxes(EventWorld& w, int count) {
  w.floor();
  Random random(5);
  for (int i = 0; i < count; ++i) {
    BodyDef d = body(box(0.1, 0.05, 0.15), {0.05 * (i % 3), 0.1 + 0.2 * i, 0.04 * (i % 2)});
    d.velocity = {random.uniform(-1, 1), random.uniform(-4, 0), random.uniform(-1, 1)};
    d.angular_velocity = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
    w.add(d);
  }
}

}  // namespace

TEST_CASE("event: what a tick costs is bounded by the budget, whatever happens in it") {
  // Loops end within one charge of the bound.
  for (const int budget : {1, 4}) {
    EventWorld w;
    NoMotion still;
    w.time_stepping = &still;
    w.settings.budget = budget;
    throw_boxes(w, 12);
    const double allowed = double(prices::event) * budget * 12;
    double most = 0;
    for (int i = 0; i < 60; ++i) {
      w.step();
      most = std::max(most, double(w.stepper.stats.work));
    }
    CAPTURE(budget);
    CHECK(most <= 2 * allowed);
    if (budget == 1) CHECK(still.calls > 0);
  }
}

TEST_CASE("event: a try after time-stepped ticks may spend a quarter of the budget") {
  EventWorld w(6);
  NoMotion still;
  w.time_stepping = &still;
  throw_boxes(w, 4);
  const double event = double(prices::event) * 4;
  const auto spent = [&w](int budget) {
    w.settings.budget = budget;
    w.step();
    REQUIRE(w.stepper.stats.groups == 1);
    return double(w.stepper.stats.work);
  };
  const auto wait = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      CHECK(spent(1000) == 0);
      CHECK(w.stepper.stats.time_stepped == 1);
    }
  };
  // What it takes is more than three events a body.
  for (const int budget : {1, 2}) {
    const double first = spent(budget);
    CHECK(first > budget * event);
    CHECK(first < (budget + 0.2) * event);
    wait(4);
    const double again = spent(budget);
    CHECK(again > 0.25 * budget * event);
    CHECK(again < (0.25 * budget + 0.2) * event);
    wait(8);
    // Events again, and with them the whole budget.
    const double whole = spent(1000);
    CHECK(whole > 3 * event);
    CHECK(w.stepper.stats.time_stepped == 0);
  }
}

TEST_CASE("event: work is counted the same by any number of threads" *
          doctest::test_suite("long")) {
  std::vector<uint64_t> work;
  for (const int threads : {1, 3}) {
    EventWorld w(60, threads);
    NoMotion still;
    w.time_stepping = &still;
    throw_boxes(w, 12);
    uint64_t sum = 0;
    for (int i = 0; i < 30; ++i) {
      w.step();
      sum += w.stepper.stats.work;
    }
    work.push_back(sum);
  }
  CHECK(work[0] == work[1]);
  CHECK(work[0] > 1000000);
}

TEST_CASE("event: a body that reaches far costs no more than its events") {
  // A ball, and a box that is held a hundred kilometres away from it: at the box a microradian is a
  // decimetre.
  EventWorld w;
  NoMotion still;
  w.time_stepping = &still;
  BodyDef lever = body(sphere(0.1), {0, 0.3, 0});
  lever.shapes.push_back(lever.shapes[0]);
  lever.shapes[1].shape = box(0.2, 0.2, 0.2);
  lever.shapes[1].pose.x = {-1e5, 0, 0};
  const uint32_t slot = w.add(lever);
  w.add(body(box(0.2, 0.2, 0.2), {0, -0.5, 0}));
  w.bodies[slot].omega = {0, 0, 1e-4};
  for (int i = 0; i < 20; ++i) {
    w.step();
    REQUIRE(double(w.stepper.stats.work) <= 2.0 * prices::event * w.settings.budget * 2);
  }
}

TEST_CASE("event: steps follow the springs that are told of") {
  // A ball on a spring, of which a tick as a step would be up to 40 rad: rk4 blows up at 2.8.
  for (const double per_tick : {0.5, 10.0, 40.0}) {
    EventWorld w;
    w.gravity.setZero();
    const uint32_t slot = w.add(body(sphere(0.1), {0.01, 0, 0}));
    const double rate = per_tick / w.h, k = rate * rate * w.bodies[slot].mass;
    w.extra_force = [k](uint32_t, RigidBody& b) { b.force -= k * b.pose.x; };
    const std::vector<double> rates{rate};
    w.spring_rates = rates;
    const double start = 0.5 * k * 1e-4;
    for (int i = 0; i < 60; ++i) {
      w.step();
      const RigidBody& b = w.bodies[slot];
      const double energy = b.kinetic_energy() + 0.5 * k * b.pose.x.squaredNorm();
      REQUIRE(energy < 1.001 * start);
    }
  }
}

TEST_CASE("event: what is computed again with longer reaches has no budget of its own") {
  // A ball whose force grows with its way, beyond what its state says, and so comes to where
  // another might be: all is computed again. The ball has spent twice; boxes far away, which are
  // none of its business, have their budget whole.
  const auto work_of = [](bool boxes, bool other) {
    EventWorld w;
    if (boxes) throw_boxes(w, 3);
    BodyDef d = body(sphere(0.1), {50, 1, 0});
    d.velocity = {1, 0, 0};
    const uint32_t ball = w.add(d);
    if (other) w.fixed(box(0.1, 0.1, 0.1), {50.15, 1.24, 0});
    w.extra_force = [&](uint32_t slot, RigidBody& b) {
      if (slot == ball) b.force.x() += b.mass * 3e4 * (b.pose.x.x() - 50);
    };
    w.step();
    return double(w.stepper.stats.work);
  };
  CHECK(work_of(false, true) > 1.8 * work_of(false, false));
  CHECK(work_of(true, true) - work_of(false, true) == work_of(true, false) - work_of(false, false));
}
