// The accuracy cases A1 to A8 (tests/support/accuracy/cases.hpp) under the event stepper, through
// World. References: closed forms (rolling and sliding by Coulomb's law, parabolas between
// bounces, Newton's cradle and its simultaneous answer, statics), conservation laws, and Euler's
// equations at small steps for the number of flips.
#include "tests/support/accuracy/cases.hpp"
#include "tests/world/event_case.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 level(double degrees) {
  const double a = degrees * M_PI / 180;
  return {std::cos(a), 0, std::sin(a)};
}

}  // namespace

TEST_CASE(
    "accuracy: a slab rolls on balls as the closed form says, whichever way it is pulled (A1)") {
  for (const double degrees : {0.0, 60.0, 205.0}) {
    const RollingErrors e = a1_rolling(event_maker(), 60, level(degrees), case_seconds(4, 1));
    CAPTURE(degrees);
    CHECK(e.slab < 1e-9);
    CHECK(e.ball < 1e-9);
  }
}

TEST_CASE("accuracy: an elastic ball keeps its height and its time over 100 bounces (A2)") {
  for (const double seconds : {20.0, case_seconds(200, 200)}) {
    const BounceErrors e = a2_bounces(event_maker(), 60, seconds);
    CHECK(e.height < 1e-6);
    CHECK(e.energy_most < 1e-9);
    CHECK(e.place < 1e-6);
  }
}

TEST_CASE("accuracy: Newton's cradle swings, touching or not (A4)") {
  for (const char* law : {"reflections", "sequential"})
    for (const double gap : {0.0, 0.01}) {
      WorldSettings s = event_settings();
      s.event.impulses = law;
      const CradleErrors e = a4_cradle(event_maker(s), 60, gap);
      CAPTURE(law);
      CHECK(e.velocity < 1e-12);
      CHECK(std::fabs(e.energy) < 1e-12);
    }
}

TEST_CASE("accuracy: the simultaneous laws move a touching cradle by their closed form (A4)") {
  for (const char* law : {"simultaneous_newton", "simultaneous_poisson"}) {
    WorldSettings s = event_settings();
    s.event.impulses = law;
    CAPTURE(law);
    CHECK(a4_cradle(event_maker(s), 60, 0.01).velocity < 1e-12);
    // The first two part at 1 m/s, the others stay together: 5 u - 1 = 1.
    const CradleErrors e = a4_cradle(event_maker(s), 60, 0);
    for (size_t i = 0; i < 5; ++i)
      CHECK(e.v[i] == doctest::Approx(i == 0 ? -0.6 : 0.4).epsilon(1e-12));
    CHECK(std::fabs(e.energy) < 1e-12);
  }
}

TEST_CASE("accuracy: a double pendulum keeps its energy, to fourth order, and its joints (A5)") {
  const auto swing = [](int hz, const char* integrator) {
    WorldSettings s = event_settings();
    s.event.integrator = integrator;
    const PendulumErrors e = a5_double_pendulum(event_maker(s), hz, case_seconds(60, 60));
    CHECK(e.joint < 1e-11);
    return e.energy_most;
  };
  CHECK(swing(240, "rk4") < 2e-5);
  CHECK(swing(60, "rk45") < 1e-6);
  const double coarse = swing(480, "rk4"), fine = swing(1920, "rk4");
  CHECK(coarse < 1e-6);
  CHECK(0.5 * std::log2(coarse / fine) > 3.9);
}

TEST_CASE("accuracy: a spinning T-handle keeps its angular momentum and flips in time (A6)") {
  for (const int hz : {60, 240}) {
    const HandleErrors e = a6_handle(event_maker(), hz);
    CAPTURE(hz);
    CHECK(e.momentum_most < 1e-12);
    CHECK(e.energy_most < (hz == 60 ? 1e-6 : 1e-8));
    CHECK(e.flips == e.flips_wanted);
    CHECK(e.flips == 9);
  }
}

TEST_CASE(
    "accuracy: the friction cone is round to 1e-6, and as wide as it should be to 2e-5 (A7)") {
  // Slip slower than 1e-6 m/s is none: what gains less than that in a tick stays where it is.
  double least = 1, most = 0;
  for (const double degrees : {0.0, 17.0, 45.0, 90.0, 230.0}) {
    double low = 0.5 * (1 - 1e-6), high = 0.5 * (1 + 2e-5);
    CAPTURE(degrees);
    CHECK(a7_slide(event_maker(), 60, level(degrees), low, 1).speed < 1e-9);
    CHECK(a7_slide(event_maker(), 60, level(degrees), high, 1).speed > 1e-5);
    for (int i = 0; i < 6; ++i) {
      const double slope = 0.5 * (low + high);
      (a7_slide(event_maker(), 60, level(degrees), slope, 1).speed > 1e-5 ? high : low) = slope;
    }
    least = std::min(least, low);
    most = std::max(most, high);
  }
  CHECK(most - least < 0.5e-6);
  MESSAGE("from ", least, " to ", most);
}

TEST_CASE("accuracy: what slides accelerates as Coulomb says, straight down, slow or fast (A7)") {
  for (const double degrees : {0.0, 30.0, 45.0, 77.0})
    for (const double slope : {0.5002, 0.51, 0.8}) {
      const double tilt = std::atan(slope);
      const double v = 2 * 9.81 * (std::sin(tilt) - 0.5 * std::cos(tilt));
      const Slide down = a7_slide(event_maker(), 60, level(degrees), slope, 2);
      CAPTURE(degrees);
      CAPTURE(slope);
      CHECK(down.speed == doctest::Approx(v).epsilon(1e-6));
      CHECK(down.distance == doctest::Approx(v).epsilon(1e-6));  // v t / 2 after 2 s
      CHECK(down.across < 1e-9);
    }
}

TEST_CASE("accuracy: what the cone holds does not creep in a minute (A7)") {
  for (const double degrees : {0.0, 30.0, 45.0, 77.0}) {
    const Slide rest = a7_slide(event_maker(), 60, level(degrees), 0.45, case_seconds(60, 60));
    CAPTURE(degrees);
    CHECK(std::fabs(rest.distance) < 1e-9);
    CHECK(rest.across < 1e-9);
  }
}

TEST_CASE("accuracy: a mass of 1000 kg on one of 1 kg does not sink (A8)") {
  for (const double mass : {100.0, 1000.0}) {
    const SinkErrors e = a8_sink(event_maker(), 60, mass);
    CHECK(std::fabs(e.end) < 1e-8);
    CHECK(e.most < 1e-8);
    CHECK(e.speed < 1e-9);
  }
}

TEST_CASE("accuracy: the forces under a tower of twelve boxes add up to its weight") {
  CaseScene s;
  s.bodies.push_back(case_floor(0.5));
  for (int i = 0; i < 12; ++i)
    s.bodies.push_back(
        case_box({0.01 * (i % 3), 0.5 + i, 0.02 * (i % 2)}, {0.5, 0.5, 0.5}, 1000, 0.5));
  const double weight = 12 * 1000 * 9.81;
  const auto weigh = [&](const World& w) {
    const Frame& f = *w.frame();
    Vec3 sum = Vec3::Zero();
    for (const ContactFrame& c : f.all_contacts())
      if (c.a == f.body(0).id) sum += c.impulse / f.rate.tick();
    CHECK((sum - Vec3(0, weight, 0)).norm() < 1e-9 * weight);
  };
  CaseRun run(s, event_maker(event_settings(), weigh), 60);
  for (int i = 0; i < int(60 * case_seconds(10, 1)); ++i) run.step();
  for (size_t i = 0; i < s.bodies.size(); ++i)
    CHECK((run[i].pose.x - s.bodies[i].pose.x).norm() < 1e-9);
}
