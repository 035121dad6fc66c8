// Reference: a machine made up here, whose pictures take a part that goes with the pixels and a
// part that does not.
#include "viewer/render/resolution_control.hpp"

#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Machine {
  double fixed = 0.003, full = 0.02;  ///< [s]
  double seconds(float resolution) const {
    return fixed + full * double(resolution) * double(resolution);
  }
};

/// From -1 to 1, without order.
double jitter(int i) {
  const double x = 0.618033988749895 * i;
  return 2 * (x - std::floor(x)) - 1;
}

/// How often the resolution changes in so many pictures.
int changes(ResolutionControl& control, const Machine& machine, int pictures) {
  int n = 0;
  for (int i = 0; i < pictures; ++i) {
    const float before = control.resolution();
    control.see(machine.seconds(before));
    n += control.resolution() != before;
  }
  return n;
}

}  // namespace

TEST_CASE("pictures that are fluent keep all their pixels, one that is not among them too") {
  ResolutionControl control;
  CHECK(changes(control, {}, 500) == 0);
  control.see(2);
  CHECK(changes(control, {}, 500) == 0);
  CHECK(control.resolution() == 1);
}

TEST_CASE("slow pictures lose pixels until they are fluent, and stay so") {
  for (const double full : {0.04, 0.06, 0.09, 0.11}) {
    const Machine machine{0.003, full};
    ResolutionControl control;
    changes(control, machine, 200);
    CAPTURE(full);
    CHECK(control.resolution() < 1);
    CHECK(machine.seconds(control.resolution()) <= 1.0 / 27);
    CHECK(changes(control, machine, 2000) == 0);
  }
}

TEST_CASE("a display of 30 Hz with jitter is not a slow machine") {
  ResolutionControl control;
  for (int i = 0; i < 3000; ++i) {
    control.see(1.0 / 30 + 0.002 * jitter(i));
    REQUIRE(control.resolution() == 1);
  }
}

TEST_CASE("on a display of 30 Hz all pixels come back, and trials that fail become rare") {
  constexpr double period = 1.0 / 30;
  // Pictures wait for the display: one period, or two ...
  const auto run = [&](ResolutionControl& control, const Machine& machine, int pictures) {
    int n = 0;
    for (int i = 0; i < pictures; ++i) {
      const float before = control.resolution();
      control.see(period * std::ceil(machine.seconds(before) / period), period);
      n += control.resolution() != before;
    }
    return n;
  };
  ResolutionControl control;
  run(control, {0.003, 0.09}, 100);
  REQUIRE(control.resolution() < 1);
  run(control, {0.003, 0.005}, 300);
  CHECK(control.resolution() == 1);
  // There is time for .71 of the pixels a side and not for .84.
  run(control, {0.003, 0.05}, 6000);
  CHECK(run(control, {0.003, 0.05}, 6000) <= 24);
}

TEST_CASE("where fewer pixels do not help, all of them come back and stay") {
  ResolutionControl control;
  const Machine simulation{0.05, 0.004};  // most of the time is not for pixels
  const auto see = [&](int pictures, bool whole) {
    for (int i = 0; i < pictures; ++i) {
      control.see(simulation.seconds(control.resolution()) * (1 + 0.02 * jitter(i)));
      if (whole) REQUIRE(control.resolution() == 1);
    }
  };
  see(6, false);
  CHECK(control.resolution() < 1);
  see(6, false);
  CHECK(control.resolution() == 1);
  see(3000, true);

  // What is there to draw becomes much more: that is another matter.
  changes(control, {0.003, 0.09}, 50);
  CHECK(control.resolution() < 1);
}

TEST_CASE("a machine too slow for any resolution ends at half, and no trial follows") {
  ResolutionControl control;
  changes(control, {0.05, 0.5}, 100);
  CHECK(control.resolution() == 0.5f);
  CHECK(changes(control, {0.05, 0.5}, 1000) == 0);
}

TEST_CASE("all pixels come back when there is time, within a few seconds") {
  ResolutionControl control;
  changes(control, {0.003, 0.2}, 50);
  REQUIRE(control.resolution() == 0.5f);
  changes(control, {0.003, 0.005}, 150);
  CHECK(control.resolution() == 1);
}

TEST_CASE("a load that comes and goes does not make pictures pulse") {
  ResolutionControl control;
  int n = 0;
  for (int round = 0; round < 100; ++round) {
    n += changes(control, {0.003, 0.09}, 20);   // in motion
    n += changes(control, {0.003, 0.001}, 40);  // and at rest
  }
  CHECK(n < 40);
}
